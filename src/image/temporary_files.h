// Temporary files that go with the process, however it ends but by SIGKILL.
#pragma once

#include <cstddef>
#include <string>

namespace troffer {

// A file of that path is to be removed if the process is ended by a signal's handler, while this
// lives. Make it before the file.
class TemporaryFile {
 public:
  TemporaryFile() = default;
  explicit TemporaryFile(const std::string& path);
  ~TemporaryFile() { forget(); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  TemporaryFile(TemporaryFile&& other) noexcept;
  TemporaryFile& operator=(TemporaryFile&& other) noexcept;
  void forget() noexcept;

 private:
  static constexpr size_t none = ~size_t(0);
  size_t slot_ = none;
};

// Removes them all, and any that would be made later. For a signal handler that is about to end the
// process: calls nothing that is not safe there.
void remove_temporary_files() noexcept;
// Whether that was called: who has just made a temporary file has to remove it himself.
bool are_temporary_files_removed() noexcept;

}  // namespace troffer
