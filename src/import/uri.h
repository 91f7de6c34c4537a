// The URIs that glTF files use: relative references and data URIs.
// References: [1] RFC 3986, Uniform Resource Identifier; [2] RFC 2397, The "data" URL scheme;
//   [3] RFC 4648, Base64.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace troffer {

// %41 -> A [1] §2.1; nothing where a '%' is not followed by two hexadecimal digits.
std::optional<std::string> percent_decoded(std::string_view text);

// Whether the text begins with a scheme ("http:", "data:" …) [1] §3.1.
bool has_uri_scheme(std::string_view uri);

struct DataUri {
  std::string media_type;  // lower case, without parameters; may be empty
  std::vector<uint8_t> bytes;
};

bool is_data_uri(std::string_view uri);

// Decodes "data:[type][;base64],data" [2]; nothing where it is malformed.
std::optional<DataUri> parse_data_uri(std::string_view uri);

// Base64 [3] §4 with or without padding; nothing where a character or the length is wrong.
std::optional<std::vector<uint8_t>> base64_decoded(std::string_view text);

}  // namespace troffer
