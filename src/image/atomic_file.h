// Output files that are whole or absent.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "image/output_target.h"
#include "image/temporary_files.h"

namespace troffer {

// Writes to a temporary file beside the target; commit() renames it. Without commit() the
// temporary goes and the target stays as it was, also where a signal's handler ends the process
// (temporary_files.h). A target that exists and is no regular file (a pipe, a device), and an open
// file of this process (/dev/stdout), is written directly; a link keeps pointing to its file, which
// is replaced; a replaced file keeps its permissions.
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
  // The first half of commit(): all bytes are there, errors of writing have been told. to_disk: the
  // disk has them. What follows can fail only as renaming does.
  void finish(bool to_disk = false);
  // As commit(), once the disk has the bytes: whole even where the power fails.
  void commit_to_disk();

 private:
  void open_temporary();
  void discard() noexcept;

  std::string path_;  // as the caller gave it
  OutputTarget target_;
  std::string temporary_;  // empty: none, the target is written directly
  TemporaryFile cleaner_;
  int descriptor_ = -1;
  bool is_written_ = false;  // finish() was called
};

// Temporary files beside `path` that programs left which were killed: those of AtomicFile that
// nobody holds any more and that are older than a minute.
void remove_abandoned_files(const std::string& path);

// The whole of a small file in one call.
void write_file(const std::string& path, std::string_view text);

// An output that can be written, to be made before long work and kept until it is written: throws
// as AtomicFile would if the file cannot be begun. A pipe is held open, as its reader would take it
// for ended else.
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
