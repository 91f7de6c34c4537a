// The texts of options, taken apart.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace troffer {

// A finite number and nothing else, or none.
std::optional<double> parse_number(const std::string& text);

// One part more than there are separators.
std::vector<std::string> split_text(const std::string& text, char separator);

}  // namespace troffer
