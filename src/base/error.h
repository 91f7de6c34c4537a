// The three kinds of failure that end a command (troffer/error.h), and CHECK for bugs.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

#include "troffer/error.h"

namespace troffer {

// Prints the failed condition, where, and what this thread was working on, then aborts.
[[noreturn]] void check_failed(const char* condition, const char* file, int line);

// The command that reproduces a run, for the message of a failed CHECK; set once by app/.
void set_check_command(std::string command);

// What the calling thread works on, for the message of a failed CHECK: a batch of items, of which
// name(batch, i) says "pixel (3,4), sample 0". It is called only once a CHECK has failed; the batch
// must stay as it is until then. A context within another one takes its place while it lives.
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

// Lives as long as a loop over items of the batch; at(i) says at which it is and costs one store.
// Outside such loops the message names the first and the last item of the batch.
class CheckItems {
 public:
  CheckItems() = default;
  ~CheckItems() { at(CheckContext::no_item); }
  CheckItems(const CheckItems&) = delete;
  CheckItems& operator=(const CheckItems&) = delete;
  void at(size_t item) { CheckContext::item_ = item; }
};

// Lives as long as a part of the batch is worked on, whose items are numbered from 0 again:
// `first`, by the batch's own numbers, is the first of them.
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

// What the calling thread works on, in words; empty outside of any context.
std::string check_place();

}  // namespace troffer

// A condition that only a bug can break; stays on in release builds.
#define TROFFER_CHECK(condition) \
  ((condition) ? void(0) : ::troffer::check_failed(#condition, __FILE__, __LINE__))
