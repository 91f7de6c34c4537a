// Meshes compressed by Google's Draco: the only door to that library.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace troffer {

struct DracoAttribute {
  uint32_t id = 0;          // the encoder's unique number
  uint32_t components = 0;  // 1 to 4
  std::vector<float> values;
  // What an integer attribute's values are divided by where a format says that they are normalised;
  // 1: they are, or are floats.
  float largest = 1;
};

struct DracoMesh {
  uint64_t vertex_count = 0;
  std::vector<uint32_t> indices;  // three per triangle, all below vertex_count
  std::vector<DracoAttribute> attributes;
  std::string problem;  // why there is nothing; empty: all is well

  const DracoAttribute* find(uint32_t id) const;
};

// Decodes `bytes`: triangles and the attributes of these ids (others, and ids that are not there,
// are left out). What its header claims is compared with the length of the data, and with
// `max_triangles`, before memory is taken.
DracoMesh decode_draco(std::span<const uint8_t> bytes, std::span<const uint32_t> ids,
                       uint64_t max_triangles);

}  // namespace troffer
