// The data that help, completion, the manual and docs/reference/options.md show of each option
// beside its description: its group, the name of its value and the files it takes. The order is
// that of help.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace troffer {

struct OptionRow {
  const char* name;   // "--size", or a positional's: "scene"; "bake --spp" is of that command alone
  const char* group;  // the heading it stands under
  const char* value;  // "WxH"; empty: a flag
  const char* files;  // endings of its files, "exr|png"; "*": any; "/": a folder; empty: no file
};

// The row of an option of that command; null where the table lacks it.
const OptionRow* row_of(const std::string& command, const CLI::Option& option);

// All options of a command as help lists them: by groups, common ones first. Those that the table
// lacks come last, under "Other".
struct OptionGroup {
  std::string name;
  std::vector<const CLI::Option*> options;
};
std::vector<OptionGroup> grouped_options(const CLI::App& command);

// "-o,--output"; "SCENE" for a positional.
std::string name_shown(const std::string& command, const CLI::Option& option);
// "WxH"; empty for a flag.
std::string value_shown(const std::string& command, const CLI::Option& option);

}  // namespace troffer
