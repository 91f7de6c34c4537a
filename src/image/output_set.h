// Several output files of one command, replaced together.
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

// The bytes that write_image() would write to that path; errors as there.
std::vector<uint8_t> encode_image(const std::string& path, std::span<const Layer> layers,
                                  const WriteOptions& options);

// Everything is written to temporary files first; commit() then renames them in the order in which
// they were added, so that the main file, added last, never stands beside older ones of its set.
// Before commit() a failure leaves all targets as they were. Errors: as AtomicFile and
// write_image() have them.
class OutputSet {
 public:
  void add(const std::string& path, std::span<const uint8_t> bytes);
  void add(const std::string& path, std::string_view text);
  // Writes an image in the format of write_image().
  void add(const std::string& path, std::span<const Layer> layers, const WriteOptions& options);

  // to_disk: whole even where the power fails.
  void commit(bool to_disk = false);

 private:
  std::vector<std::unique_ptr<AtomicFile>> files_;
};

}  // namespace troffer
