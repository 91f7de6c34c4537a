#include "import/kept_files.h"

#include <atomic>

#include "base/error.h"

namespace troffer {

namespace {

std::atomic<KeptFiles*> keeping{nullptr};

}  // namespace

KeptFiles::KeptFiles() {
  KeptFiles* none = nullptr;
  TROFFER_CHECK(keeping.compare_exchange_strong(none, this));
}

KeptFiles::~KeptFiles() {
  keeping = nullptr;
}

KeptFiles::Bytes KeptFiles::find(const std::string& path) {
  const KeptFiles* files = keeping;
  if (files == nullptr) return nullptr;
  const std::lock_guard lock(files->mutex_);
  const auto at = files->files_.find(path);
  return at == files->files_.end() ? nullptr : at->second;
}

void KeptFiles::keep(const std::string& path, const void* bytes, size_t size) {
  KeptFiles* files = keeping;
  if (files == nullptr) return;
  const auto* first = static_cast<const uint8_t*>(bytes);
  auto kept = std::make_shared<const std::vector<uint8_t>>(first, first + size);
  const std::lock_guard lock(files->mutex_);
  files->files_[path] = std::move(kept);
}

}  // namespace troffer
