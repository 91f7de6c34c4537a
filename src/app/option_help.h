// Texts of --help and `troffer help`, and the same as JSON. tools/manual.py makes manual pages,
// shell completion and docs/reference/options.md from the JSON.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace troffer {

// Lists the commands, one per line.
std::string commands_help(const CLI::App& program);
// Returns usage and grouped options of a command, at most 80 columns wide.
std::string command_help(const CLI::App& command);
// Returns all commands as JSON: {"summary", "commands": [{"name", "summary", "usage", "groups":
// [{"name", "options": [{"names", "value", "text", "full_text" (with range, choices and default),
// "range", "choices", "default", "files", "is_required", "is_repeatable", "is_positional"}]}]}]}.
std::string help_json(const CLI::App& program);

// Makes --help of the program and its commands print these texts.
void set_help(CLI::App& program);

}  // namespace troffer
