// The three kinds of failure that end a command, and CHECK for bugs.
#pragma once

#include <stdexcept>
#include <string>

namespace troffer {

// A file that cannot be used as it is. Thrown by readers, caught once in app/, printed as
// "error: FILE:LINE:COLUMN: what". Line and column count from 1; 0 = the file as a
// whole, printed as 1:1.
class InputError : public std::runtime_error {
 public:
  InputError(std::string file, int line, int column, std::string what);
  const std::string& file() const { return file_; }
  const std::string& reason() const { return reason_; }
  int line() const { return line_; }
  int column() const { return column_; }

 private:
  std::string file_, reason_;
  int line_, column_;
};

// The world around us failed: cannot write, disk full, out of memory.
class EnvironmentError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The command line asks for something that does not exist (exit status 2).
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Prints the failed condition, where, and what this thread was working on, then aborts.
[[noreturn]] void check_failed(const char* condition, const char* file, int line);

// What the calling thread works on, for the message of a failed CHECK, e.g. "pixel (3,4)".
// The command that reproduces a run is set once by app/.
void set_check_command(std::string command);
struct CheckContext {
  CheckContext(int pixel_x, int pixel_y, int sample);
  ~CheckContext();
  CheckContext(const CheckContext&) = delete;
  CheckContext& operator=(const CheckContext&) = delete;
};

}  // namespace troffer

// A condition that only a bug can break; stays on in release builds.
#define TROFFER_CHECK(condition) \
  ((condition) ? void(0) : ::troffer::check_failed(#condition, __FILE__, __LINE__))
