// Checks numbers on the command line: they must be decimal, finite and within the range of their
// type. The parser alone would take -1 for 18446744073709551615, 010 for 8, and nan for a number in
// any range.
#pragma once

#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace troffer {

enum class NumberKind { natural, integer, real };

// Returns what is wrong with `text` as such a number; empty if it is valid. Removes a plus sign and
// leading zeros.
std::optional<std::string> check_number(NumberKind kind, std::string& text);

// Applies check_number() to all numeric options of all commands.
void require_plain_numbers(CLI::App& app);

}  // namespace troffer
