// What an output path stands for, and how it is opened: a regular file that is to be replaced, or
// something that takes what is written as it comes.
#pragma once

#include <string>

namespace troffer {

struct OutputTarget {
  // file: a regular file, or none yet, at `path`; stream: a pipe or a device at `path`;
  // descriptor: an open file of this process (/dev/stdout, /dev/fd/3), whatever that is.
  enum class Kind { file, stream, descriptor };
  Kind kind = Kind::file;
  std::string path;  // behind links
  int descriptor = -1;
};

// Links are followed. Throws EnvironmentError{"cannot write PATH: reason"} for what can be no
// output: a folder, a disk, a socket, what may not be written.
OutputTarget output_target(const std::string& path);

// Opens a stream or a descriptor for writing. Of a pipe that nobody reads from, a reader is awaited
// for some seconds only; then, as for all that cannot be opened, errors are as above. `path` names
// it there.
int open_stream(const OutputTarget& target, const std::string& path);

[[noreturn]] void fail_to_write(const std::string& path, const std::string& reason);
[[noreturn]] void fail_to_write(const std::string& path, int error);

// Writes all, or throws as above. A reader that went away (SIGPIPE) and a limit on the size of
// files (SIGXFSZ) are errors like others here and end no process.
void write_all(int descriptor, const void* bytes, size_t size, const std::string& path);

}  // namespace troffer
