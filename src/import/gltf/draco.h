// Decoder of meshes compressed by Google's library Draco. No other file includes that library.
// gltf_primitive.cpp uses it for KHR_draco_mesh_compression. Errors are returned as text, because
// this module does not know the place in the file.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace troffer {

// Values of one attribute, converted to floats.
struct DracoAttribute {
  uint32_t id = 0;          // the encoder's unique number
  uint32_t components = 0;  // 1 to 4
  std::vector<float> values;
  // Divisor that turns the values into normalised ones, for formats that declare the attribute
  // normalised: the largest value of an 8- or 16-bit integer type. 1 for floats and for values that
  // are already normalised.
  float largest = 1;
};

// A decoded mesh, or the reason why there is none.
struct DracoMesh {
  uint64_t vertex_count = 0;
  std::vector<uint32_t> indices;  // three per triangle, all below vertex_count
  std::vector<DracoAttribute> attributes;
  std::string problem;  // reason why decoding failed; empty on success

  const DracoAttribute* find(uint32_t id) const;
};

// Decodes the triangles of `bytes` and the attributes with the given ids. Skips other attributes,
// and ids that are missing. Before memory is allocated, the counts in the header are checked
// against the length of the data and `max_triangles`.
DracoMesh decode_draco(std::span<const uint8_t> bytes, std::span<const uint32_t> ids,
                       uint64_t max_triangles);

}  // namespace troffer
