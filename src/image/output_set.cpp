#include "image/output_set.h"

#include <algorithm>

#include "image/encode.h"

namespace troffer {

void OutputSet::add(const std::string& path, std::span<const uint8_t> bytes) {
  auto file = std::make_unique<AtomicFile>(path);
  file->write(bytes);
  files_.push_back({path, std::move(file)});
}

void OutputSet::add(const std::string& path, std::string_view text) {
  add(path, std::span(reinterpret_cast<const uint8_t*>(text.data()), text.size()));
}

void OutputSet::add(const std::string& path, std::span<const Layer> layers,
                    const WriteOptions& options) {
  add(path, encode_image(path, layers, options));
}

void OutputSet::rename_last(const std::string& path) {
  const auto main =
      std::find_if(files_.begin(), files_.end(), [&](const Output& o) { return o.path == path; });
  if (main != files_.end()) std::rotate(main, main + 1, files_.end());
}

void OutputSet::commit(bool to_disk) {
  for (const Output& o : files_) o.file->finish(to_disk);
  for (const Output& o : files_) {
    if (to_disk)
      o.file->commit_to_disk();
    else
      o.file->commit();
  }
  files_.clear();
}

}  // namespace troffer
