// Output files that are complete or absent. Commands write their outputs through it, so that an
// interrupted run never leaves a partial file or destroys an old one. OutputReservation checks an
// output before long work.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "image/output_target.h"
#include "image/temporary_files.h"

namespace troffer {

// Writes to a temporary file in the target's folder; commit() renames it to the target. Without
// commit() the temporary file is removed and the target stays unchanged, even if a signal handler
// ends the process (temporary_files.h). A pipe, a device or an open file of this process
// (/dev/stdout) is written directly. A link keeps pointing to its file, which is replaced. A
// replaced file keeps its permissions. Every failure throws EnvironmentError{"cannot write PATH:
// reason"}.
class AtomicFile {
 public:
  explicit AtomicFile(std::string path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::span<const uint8_t> bytes);
  void write(std::string_view text);
  void commit();
  // First half of commit(): writes all bytes and reports errors of writing. to_disk also flushes
  // them to the disk. After it, commit() can fail only in renaming.
  void finish(bool to_disk = false);
  // Same as commit(), but the new file is complete even after a power failure.
  void commit_to_disk();

 private:
  void open_temporary();
  void discard() noexcept;

  std::string path_;  // as given by the caller
  OutputTarget target_;
  std::string temporary_;  // empty: the target is written directly
  TemporaryFile cleaner_;
  int descriptor_ = -1;
  bool is_written_ = false;  // finish() was called
};

// Removes temporary files next to `path` that killed programs left: files of AtomicFile that no
// process holds and that are older than a minute.
void remove_abandoned_files(const std::string& path);

// Writes a small file in one call.
void write_file(const std::string& path, std::string_view text);

// Checks that an output can be written. Make it before long work and keep it until the output is
// written. Throws like AtomicFile if the file cannot be created. A pipe is held open, because its
// reader would otherwise see the end of the data.
class OutputReservation {
 public:
  explicit OutputReservation(const std::string& path);
  ~OutputReservation();
  OutputReservation(OutputReservation&& other) noexcept;
  OutputReservation& operator=(OutputReservation&&) = delete;

 private:
  int descriptor_ = -1;
};

}  // namespace troffer
