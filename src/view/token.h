// Makes and compares the secret in the page's address. Requests without it are refused.
#pragma once

#include <string>
#include <string_view>

namespace troffer {

// Returns 128 bits of the system's random numbers as 32 hexadecimal digits. Throws EnvironmentError
// if there are none.
std::string random_token();

// Compares in constant time, so that a token cannot be guessed digit by digit.
bool is_same_token(std::string_view given, std::string_view token);

}  // namespace troffer
