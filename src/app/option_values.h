// Validators of option values. Their messages say what to write, and help, completion and the
// manual show their descriptions (app/option_help.h).
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace troffer {

// Validators of ranges. require_plain_numbers() (app/plain_numbers.h) has already rejected text
// that is no number. Descriptions read "0.5 to 10", and leave out bounds of a million or more: "1
// or more".
CLI::Validator number_between(double least, double most);
CLI::Validator whole_number_between(int64_t least, int64_t most);
CLI::Validator number_above_zero();
// Accepts one of a few words; described as "on|off".
CLI::Validator one_of(const std::vector<std::string>& words);

// Kinds of descriptions that the validators above set.
constexpr const char* number_kind = "NUMBER";
constexpr const char* whole_number_kind = "WHOLE";
constexpr const char* choice_kind = "CHOICE";

// Returns "a, b or c".
std::string listed_with_or(const std::vector<std::string>& words);
std::vector<std::string> split_at(const std::string& text, char separator);

}  // namespace troffer
