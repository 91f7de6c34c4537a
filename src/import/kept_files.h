// A cache of file contents, for callers that read the same files again although they may have
// changed or disappeared. `troffer view` uses it to light a scene for another time of day.
// read_file and read_text_file use the cache automatically.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace troffer {

// Keeps everything that read_file and read_text_file read while it exists. The same path then
// returns the same bytes, even if the file changes. Only one may exist at a time; thread-safe.
class KeptFiles {
 public:
  KeptFiles();
  ~KeptFiles();
  KeptFiles(const KeptFiles&) = delete;
  KeptFiles& operator=(const KeptFiles&) = delete;

  using Bytes = std::shared_ptr<const std::vector<uint8_t>>;
  // Returns null if nothing is kept under that path, or no KeptFiles exists.
  static Bytes find(const std::string& path);
  static void keep(const std::string& path, const void* bytes, size_t size);

 private:
  mutable std::mutex mutex_;
  std::map<std::string, Bytes> files_;
};

}  // namespace troffer
