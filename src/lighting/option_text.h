// Parsing of numbers and lists in option texts. The lighting options and some commands use it.
// Numbers use a decimal point, independent of the locale.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace troffer {

// Returns the finite number that is all of the text, or nothing.
std::optional<double> parse_number(const std::string& text);

// Splits a text. The result has one part more than there are separators.
std::vector<std::string> split_text(const std::string& text, char separator);

}  // namespace troffer
