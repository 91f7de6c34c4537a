// The header of a PLY file: the elements and properties that follow, and their encoding. PlyBody
// reads the data that it describes. Counts are those of the file and are not checked here.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace troffer {

enum class PlyFormat { ascii, little_endian, big_endian };
enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

// Returns the size of a scalar in a binary body, bytes.
size_t size_of(PlyType type);
inline bool is_integer(PlyType type) {
  return type < PlyType::float32;
}

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;
  bool is_list = false;
  PlyType count_type = PlyType::uint8;
};

struct PlyElement {
  std::string name;
  uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  size_t body = 0;    // offset of the first byte after the header
  int body_line = 1;  // line of that byte
};

// Parses the header. Throws InputError if the file is not PLY, its format or a type is unknown, or
// end_header is missing.
PlyHeader parse_ply_header(std::string_view text, const std::string& file);

}  // namespace troffer
