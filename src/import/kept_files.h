// Files that are read once, for who may read them again when they are gone.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace troffer {

// Keeps what read_file and read_text_file read while it lives: the same path gives the same bytes
// again, whatever becomes of the file. One at a time.
class KeptFiles {
 public:
  KeptFiles();
  ~KeptFiles();
  KeptFiles(const KeptFiles&) = delete;
  KeptFiles& operator=(const KeptFiles&) = delete;

  using Bytes = std::shared_ptr<const std::vector<uint8_t>>;
  // Null where nothing is kept under that path, or nobody asks for it.
  static Bytes find(const std::string& path);
  static void keep(const std::string& path, const void* bytes, size_t size);

 private:
  mutable std::mutex mutex_;
  std::map<std::string, Bytes> files_;
};

}  // namespace troffer
