// Several output files of one command that are replaced together. Commands use it for files that
// belong together, such as a picture and its side files or the maps of a comparison. After a
// failure all old files are unchanged.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "image/atomic_file.h"
#include "image/write_image.h"

namespace troffer {

// Returns the bytes that write_image() would write to this path; throws the same errors.
std::vector<uint8_t> encode_image(const std::string& path, std::span<const Layer> layers,
                                  const WriteOptions& options);

// Writes everything to temporary files; commit() renames them in the order of add(). Add the main
// file last, so that it never appears next to older files of its set. A failure before commit()
// leaves all targets unchanged. Throws like AtomicFile and write_image().
class OutputSet {
 public:
  void add(const std::string& path, std::span<const uint8_t> bytes);
  void add(const std::string& path, std::string_view text);
  // Adds an image in the format of write_image().
  void add(const std::string& path, std::span<const Layer> layers, const WriteOptions& options);

  // to_disk: the files are complete even after a power failure.
  void commit(bool to_disk = false);

 private:
  std::vector<std::unique_ptr<AtomicFile>> files_;
};

}  // namespace troffer
