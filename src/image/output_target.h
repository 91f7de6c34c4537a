// Kind of an output path, and how to open it: a regular file to be replaced, or a stream that is
// written directly. AtomicFile uses it. Errors are EnvironmentErrors of the form "cannot write
// PATH: reason".
#pragma once

#include <string>

namespace troffer {

struct OutputTarget {
  // file: a regular file, or none yet, at `path`. stream: a pipe or device at `path`. descriptor:
  // an open file of this process (/dev/stdout, /dev/fd/3) of any kind.
  enum class Kind { file, stream, descriptor };
  Kind kind = Kind::file;
  std::string path;  // with links resolved
  int descriptor = -1;
};

// Classifies a path, following links. Throws EnvironmentError{"cannot write PATH: reason"} for a
// folder, a disk, a socket, or if writing is not permitted.
OutputTarget output_target(const std::string& path);

// Opens a stream or a descriptor for writing. Waits some seconds for a reader of a pipe. Throws
// like output_target() if it cannot be opened; `path` is the name in the message.
int open_stream(const OutputTarget& target, const std::string& path);

[[noreturn]] void fail_to_write(const std::string& path, const std::string& reason);
[[noreturn]] void fail_to_write(const std::string& path, int error);

// Writes all bytes or throws as above. A closed pipe (SIGPIPE) and the file size limit (SIGXFSZ)
// are ordinary errors here and do not end the process.
void write_all(int descriptor, const void* bytes, size_t size, const std::string& path);

}  // namespace troffer
