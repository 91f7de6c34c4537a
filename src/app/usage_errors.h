// Turns errors of the command line into messages that say what to write. run() prints them.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace troffer {

// Returns the message for an error that the parser found in the arguments (argv[1] on).
std::string usage_message(const CLI::App& program, int argc, const char* const* argv,
                          const CLI::ParseError& error);

// Returns "there is no command 'rendr'; did you mean 'render'? (troffer help lists the commands)".
std::string no_command(const CLI::App& program, const std::string& name);

}  // namespace troffer
