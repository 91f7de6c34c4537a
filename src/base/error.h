// The three exceptions that end a command, and TROFFER_CHECK for bugs. InputError is for bad files,
// EnvironmentError for failures outside the program, UsageError for bad command lines. A failed
// check prints the item of work, such as a pixel, and aborts.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

#include "troffer/error.h"

namespace troffer {

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
