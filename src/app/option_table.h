// Table of what help, completion, the manual and docs/reference/options.md show of each option
// besides its description: group, name of the value, and files. Its order is the order of help.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace troffer {

// Display data of one option.
struct OptionRow {
  const char* name;  // "--size", or a positional: "scene"; "bake --spp" applies to one command only
  const char* group;  // heading of its group
  const char* value;  // "WxH"; empty for a flag
  const char* files;  // endings of its files, "exr|png"; "*": any file; "/": a folder; empty: no
                      // file
};

// Returns the row of a command's option; null if the table lacks it.
const OptionRow* row_of(const std::string& command, const CLI::Option& option);

// The options of a command under one heading. Groups have the order of help, and options without a
// row come last under "Other".
struct OptionGroup {
  std::string name;
  std::vector<const CLI::Option*> options;
};
std::vector<OptionGroup> grouped_options(const CLI::App& command);

// Returns "-o,--output", or "SCENE" for a positional.
std::string name_shown(const std::string& command, const CLI::Option& option);
// Returns "WxH", or an empty text for a flag.
std::string value_shown(const std::string& command, const CLI::Option& option);

}  // namespace troffer
