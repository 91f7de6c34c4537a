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

// Writes everything to temporary files; commit() renames them in the order of add(). The main file
// is renamed last, so that it never appears next to older files of its set: add it last, or name it
// by rename_last(). A failure before commit() leaves all targets unchanged. A process that is
// killed during commit() may leave other files new beside the old main file. Throws like AtomicFile
// and write_image().
class OutputSet {
 public:
  void add(const std::string& path, std::span<const uint8_t> bytes);
  void add(const std::string& path, std::string_view text);
  // Adds an image in the format of write_image().
  void add(const std::string& path, std::span<const Layer> layers, const WriteOptions& options);

  // Lets commit() rename a file after all others. Does nothing for a path that was not added.
  void rename_last(const std::string& path);

  // to_disk: the files are complete even after a power failure.
  void commit(bool to_disk = false);

 private:
  struct Output {
    std::string path;
    std::unique_ptr<AtomicFile> file;
  };
  std::vector<Output> files_;
};

}  // namespace troffer
