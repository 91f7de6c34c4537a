#include "base/error.h"

#include <cstdio>
#include <cstdlib>

namespace troffer {

namespace {

std::string located(const std::string& file, int line, int column, const std::string& what) {
  if (file.empty()) return what;
  if (line < 0) return file + ": " + what;  // a missing file has no lines
  // Errors of a whole file are reported at 1:1, so that there is always a place.
  const bool has_place = line > 0;
  return file + ":" + std::to_string(has_place ? line : 1) + ":" +
         std::to_string(has_place ? column : 1) + ": " + what;
}

thread_local const CheckContext* context = nullptr;

std::string& check_command() {
  static std::string command;
  return command;
}

}  // namespace

InputError::InputError(std::string file, int line, int column, std::string what)
    : std::runtime_error(located(file, line, column, what)),
      file_(std::move(file)),
      reason_(std::move(what)),
      line_(line),
      column_(column) {}

void set_check_command(std::string command) {
  check_command() = std::move(command);
}

constinit thread_local size_t CheckContext::item_ = CheckContext::no_item;
constinit thread_local size_t CheckContext::first_ = 0;

CheckContext::CheckContext(const void* batch, size_t size, Name name)
    : batch_(batch),
      size_(size),
      name_(name),
      outer_(context),
      outer_item_(item_),
      outer_first_(first_) {
  context = this;
  item_ = no_item;
  first_ = 0;
}
CheckContext::~CheckContext() {
  context = outer_;
  item_ = outer_item_;
  first_ = outer_first_;
}

std::string check_place() {
  if (context == nullptr || context->size_ == 0) return {};
  const CheckContext& c = *context;
  const size_t item = CheckContext::item_;
  if (item < c.size_ && item + CheckContext::first_ < c.size_)
    return c.name_(c.batch_, item + CheckContext::first_);
  const std::string first = c.name_(c.batch_, 0);
  return c.size_ == 1 ? first : "one from " + first + " to " + c.name_(c.batch_, c.size_ - 1);
}

void check_failed(const char* condition, const char* file, int line) {
  std::fprintf(stderr, "bug: %s:%d: CHECK(%s) failed\n", file, line, condition);
  const std::string place = check_place();
  if (!place.empty()) std::fprintf(stderr, "  at %s\n", place.c_str());
  if (!check_command().empty())
    std::fprintf(stderr, "  reproduce with: %s\n", check_command().c_str());
  std::abort();
}

}  // namespace troffer
