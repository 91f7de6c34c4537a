#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <string>

#include "app/commands.h"

namespace troffer {

namespace {

struct MethodOption {
  const char* name;
  const char* methods;  // names of the methods that use it, as in a sentence
};

// Options of render and measure that not every method uses.
constexpr std::array<MethodOption, 12> method_options{{
    {"--depth", "path"},
    {"--error", "certified"},
    {"--shadow-rays", "fixed and kj92"},
    {"--variance", "kj92"},
    {"--most-rays", "kj92"},
    {"--mean-change", "kj92"},
    {"--level-difference", "kj92"},
    {"--probe-rays", "kj92"},
    {"--coherence", "kj92"},
    {"--ratio", "kj92"},
    {"--selection", "kj92"},
    {"--select", "kj92"},
}};

}  // namespace

void warn_of_unused_options(const CLI::App& command, Method method, bool is_quiet) {
  if (is_quiet) return;
  const std::string name(method.row().name);
  for (const MethodOption& o : method_options) {
    const CLI::Option* option = command.get_option_no_throw(o.name);
    if (option == nullptr || option->count() == 0) continue;
    if (std::string(o.methods).find(name) == std::string::npos)
      fmt::print(stderr, "warning: {} belongs to --method {}; {} does not use it\n", o.name,
                 o.methods, name);
  }
}

}  // namespace troffer
