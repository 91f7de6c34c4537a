// Output files that are whole or absent.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace troffer {

// Writes to a temporary file beside the target; commit() renames it. Without commit() the
// temporary goes and the target stays as it was. A target that exists and is no regular file (a
// pipe, /dev/stdout) is written directly; a link keeps pointing to its file, which is replaced; a
// replaced file keeps its permissions.
// Every failure throws EnvironmentError{"cannot write PATH: reason"}.
class AtomicFile {
 public:
  explicit AtomicFile(std::string path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::span<const uint8_t> bytes);
  void write(std::string_view text);
  void commit();

 private:
  [[noreturn]] void fail(int error) const;
  void open_temporary();
  void discard() noexcept;

  std::string path_;       // as the caller gave it
  std::string target_;     // behind links
  std::string temporary_;  // empty: none, the target is written directly
  int descriptor_ = -1;
};

// The whole of a small file in one call.
void write_file(const std::string& path, std::string_view text);

// Throws as AtomicFile would if the file cannot be begun: to be asked before long work.
void check_can_write(const std::string& path);

}  // namespace troffer
