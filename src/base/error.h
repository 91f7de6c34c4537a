// The three exceptions that end a command, and TROFFER_CHECK for bugs. InputError is for bad files,
// EnvironmentError for failures outside the program, UsageError for bad command lines. A failed
// check prints the item of work, such as a pixel, and aborts.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace troffer {

// A file cannot be used. Readers throw it; app/ catches it once and prints "error:
// FILE:LINE:COLUMN: what". Line and column count from 1; 0 means the whole file, printed as 1:1;
// -1 means that there is no file to point into, printed without a place.
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

// The environment failed: cannot write, disk full, out of memory.
class EnvironmentError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The command line asks for something that does not exist (exit status 2).
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Prints the failed condition, its place and what this thread was working on, then aborts.
[[noreturn]] void check_failed(const char* condition, const char* file, int line);

// Sets the command that reproduces the run, for the message of a failed check. Called once by app/.
void set_check_command(std::string command);

// Registers what the calling thread works on, for the message of a failed check. The work is a
// batch of items; name(batch, i) returns a text such as "pixel (3,4), sample 0". It is called only
// after a failed check. The batch must stay unchanged until then. A nested context replaces the
// outer one during its lifetime.
class CheckContext {
 public:
  using Name = std::string (*)(const void* batch, size_t item);
  CheckContext(const void* batch, size_t size, Name name);
  ~CheckContext();
  CheckContext(const CheckContext&) = delete;
  CheckContext& operator=(const CheckContext&) = delete;

 private:
  friend class CheckItems;
  friend class CheckPart;
  friend std::string check_place();
  static constexpr size_t no_item = ~size_t(0);
  const void* batch_ = nullptr;
  size_t size_ = 0;
  Name name_ = nullptr;
  const CheckContext* outer_;
  size_t outer_item_, outer_first_;
  static constinit thread_local size_t item_, first_;
};

// Marks the current item within a loop over the batch. at(i) costs one store. Outside such loops
// the message names the first and the last item.
class CheckItems {
 public:
  CheckItems() = default;
  ~CheckItems() { at(CheckContext::no_item); }
  CheckItems(const CheckItems&) = delete;
  CheckItems& operator=(const CheckItems&) = delete;
  void at(size_t item) { CheckContext::item_ = item; }
};

// Marks work on a part of the batch whose items count from 0 again. `first` is the index of its
// first item in the batch.
class CheckPart {
 public:
  explicit CheckPart(size_t first) : outer_first_(CheckContext::first_) {
    CheckContext::first_ += first;
  }
  ~CheckPart() { CheckContext::first_ = outer_first_; }
  CheckPart(const CheckPart&) = delete;
  CheckPart& operator=(const CheckPart&) = delete;

 private:
  size_t outer_first_;
};

// Text for what the calling thread works on; empty outside any context.
std::string check_place();

}  // namespace troffer

// Checks a condition that only a bug can violate. It stays on in release builds.
#define TROFFER_CHECK(condition) \
  ((condition) ? void(0) : ::troffer::check_failed(#condition, __FILE__, __LINE__))
