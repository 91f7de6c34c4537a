// Temporary files that are removed when the process ends, except by SIGKILL. AtomicFile registers
// its files, and the signal handlers (app/signals.cpp) remove them. Thread-safe.
#pragma once

#include <cstddef>
#include <string>

namespace troffer {

// Marks the file at `path` for removal if a signal handler ends the process during the lifetime of
// this object. Create it before the file.
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

// Removes all registered files, and lets none be registered later. For signal handlers that are
// about to end the process: async-signal-safe.
void remove_temporary_files() noexcept;
// True after remove_temporary_files(): code that has just made a temporary file must then remove
// it.
bool are_temporary_files_removed() noexcept;

}  // namespace troffer
