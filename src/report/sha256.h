// SHA-256. A report lists its input files with their hashes.
// Reference: [1] NIST, FIPS 180-4, "Secure Hash Standard", 2015.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace troffer {

// Returns the hash as 64 hexadecimal digits.
std::string sha256(std::span<const uint8_t> bytes);

}  // namespace troffer
