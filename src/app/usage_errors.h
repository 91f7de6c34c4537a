// Turns what is wrong with a command line into a message that says what to write.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace troffer {

// The message for a mistake that the parser found in `program`'s arguments (argv[1] on).
std::string usage_message(const CLI::App& program, int argc, const char* const* argv,
                          const CLI::ParseError& error);

// "there is no command 'rendr'; did you mean 'render'? (troffer help lists the commands)".
std::string no_command(const CLI::App& program, const std::string& name);

}  // namespace troffer
