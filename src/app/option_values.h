// Which values options take: checks whose messages say what to write, and whose descriptions help,
// completion and the manual show (app/option_help.h).
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace troffer {

// Ranges. require_plain_numbers() (app/plain_numbers.h) refuses what is no number before they look.
// "0.5 to 10"; a bound of a million or more is left out: "1 or more".
CLI::Validator number_between(double least, double most);
CLI::Validator whole_number_between(int64_t least, int64_t most);
CLI::Validator number_above_zero();
// One of a few words; "on|off".
CLI::Validator one_of(const std::vector<std::string>& words);

// Names of the validators above: kinds of what their descriptions say.
constexpr const char* number_kind = "NUMBER";
constexpr const char* whole_number_kind = "WHOLE";
constexpr const char* choice_kind = "CHOICE";

// "a, b or c".
std::string listed_with_or(const std::vector<std::string>& words);
std::vector<std::string> split_at(const std::string& text, char separator);

}  // namespace troffer
