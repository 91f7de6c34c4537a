#include "base/error.h"

#include <cstdio>
#include <cstdlib>

namespace troffer {

namespace {

std::string located(const std::string& file, int line, int column, const std::string& what) {
  if (file.empty()) return what;
  // What is wrong with a file as a whole is reported at its beginning: the place is always there.
  const bool has_place = line > 0;
  return file + ":" + std::to_string(has_place ? line : 1) + ":" +
         std::to_string(has_place ? column : 1) + ": " + what;
}

struct WorkItem {
  int x = -1, y = -1, sample = -1;
};
thread_local WorkItem work_item;

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

CheckContext::CheckContext(int pixel_x, int pixel_y, int sample) {
  work_item = {pixel_x, pixel_y, sample};
}
CheckContext::~CheckContext() {
  work_item = {};
}

void check_failed(const char* condition, const char* file, int line) {
  std::fprintf(stderr, "bug: %s:%d: CHECK(%s) failed\n", file, line, condition);
  if (work_item.x >= 0)
    std::fprintf(stderr, "  near pixel (%d,%d), sample %d\n", work_item.x, work_item.y,
                 work_item.sample);
  if (!check_command().empty())
    std::fprintf(stderr, "  reproduce with: %s\n", check_command().c_str());
  std::abort();
}

}  // namespace troffer
