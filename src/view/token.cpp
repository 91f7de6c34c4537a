#include "view/token.h"

#include <sys/random.h>

#include <array>
#include <cstddef>
#include <cstdint>

#include "base/error.h"

namespace troffer {

std::string random_token() {
  std::array<uint8_t, 16> bytes;
  if (getrandom(bytes.data(), bytes.size(), 0) != ptrdiff_t(bytes.size()))
    throw EnvironmentError("the system provides no random numbers for the page's address");
  std::string token;
  for (const uint8_t b : bytes)
    for (const int digit : {b >> 4, b & 15}) token += "0123456789abcdef"[digit];
  return token;
}

bool is_same_token(std::string_view given, std::string_view token) {
  unsigned difference = given.size() == token.size() ? 0 : 1;
  for (size_t i = 0; i < token.size(); ++i) {
    const char c = given.empty() ? '\0' : given[i % given.size()];
    difference |= unsigned(static_cast<unsigned char>(c) ^ static_cast<unsigned char>(token[i]));
  }
  return difference == 0;
}

}  // namespace troffer
