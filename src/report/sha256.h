// SHA-256, by which a report names the files that it was made from.
// Reference: [1] NIST, FIPS 180-4, "Secure Hash Standard", 2015.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace troffer {

// 64 hexadecimal digits.
std::string sha256(std::span<const uint8_t> bytes);

}  // namespace troffer
