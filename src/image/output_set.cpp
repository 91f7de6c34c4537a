#include "image/output_set.h"

#include "image/encode.h"

namespace troffer {

void OutputSet::add(const std::string& path, std::span<const uint8_t> bytes) {
  auto file = std::make_unique<AtomicFile>(path);
  file->write(bytes);
  files_.push_back(std::move(file));
}

void OutputSet::add(const std::string& path, std::string_view text) {
  add(path, std::span(reinterpret_cast<const uint8_t*>(text.data()), text.size()));
}

void OutputSet::add(const std::string& path, std::span<const Layer> layers,
                    const WriteOptions& options) {
  add(path, encode_image(path, layers, options));
}

void OutputSet::commit(bool to_disk) {
  for (const auto& file : files_) file->finish(to_disk);
  for (const auto& file : files_) {
    if (to_disk)
      file->commit_to_disk();
    else
      file->commit();
  }
  files_.clear();
}

}  // namespace troffer
