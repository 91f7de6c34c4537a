// The texts of --help and `troffer help`, and the same as JSON: tools/manual.py makes manual pages,
// shell completion and docs/reference/options.md of it.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace troffer {

// The commands, a line each.
std::string commands_help(const CLI::App& program);
// The usage and the options of a command, by groups, at most 80 columns wide.
std::string command_help(const CLI::App& command);
// All of them: {"summary", "commands": [{"name", "summary", "usage", "groups": [{"name",
// "options": [{"names", "value", "text", "full_text" (with range, choices and default), "range",
// "choices", "default", "files", "is_required", "is_repeatable", "is_positional"}]}]}]}.
std::string help_json(const CLI::App& program);

// Makes --help of the program and of its commands print the texts above.
void set_help(CLI::App& program);

}  // namespace troffer
