// URIs in glTF files: relative references and data URIs.
// References: [1] RFC 3986, Uniform Resource Identifier; [2] RFC 2397, The "data" URL scheme;
//   [3] RFC 4648, Base64.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace troffer {

// Decodes percent escapes (%41 is A [1] §2.1). Returns nothing if a '%' lacks two hexadecimal
// digits.
std::optional<std::string> percent_decoded(std::string_view text);

// True if the text begins with a scheme ("http:", "data:", …) [1] §3.1.
bool has_uri_scheme(std::string_view uri);

struct DataUri {
  std::string media_type;  // lower case, without parameters; may be empty
  std::vector<uint8_t> bytes;
};

// True if the URI has the scheme "data:", in either case.
bool is_data_uri(std::string_view uri);

// Decodes "data:[type][;base64],data" [2]; nothing if it is malformed.
std::optional<DataUri> parse_data_uri(std::string_view uri);

// Decodes base64 [3] §4, with or without padding; nothing if a character or the length is invalid.
std::optional<std::vector<uint8_t>> base64_decoded(std::string_view text);

}  // namespace troffer
