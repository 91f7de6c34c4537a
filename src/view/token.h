// The secret in the address of a page: who does not know it gets nothing.
#pragma once

#include <string>
#include <string_view>

namespace troffer {

// 128 bits of the system's random numbers, as 32 hexadecimal digits. EnvironmentError where there
// are none.
std::string random_token();

// Takes as long wherever the two differ, so that nobody finds a token digit by digit.
bool is_same_token(std::string_view given, std::string_view token);

}  // namespace troffer
