// glTF mesh primitives as the file stores them: accessors that are checked against each other.
// gltf_mesh.h turns them into meshes. Compressed primitives look the same as plain ones.
// References: [1] Khronos, glTF 2.0 Specification, §3.7 (Geometry); [2] Khronos extension
//   KHR_draco_mesh_compression.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "base/log.h"
#include "import/gltf/draco.h"
#include "import/gltf/gltf_accessor.h"
#include "import/gltf/gltf_json.h"

namespace troffer {

enum class GltfTopology : uint8_t { triangles, strip, fan };

// Displacements that a morph target adds to positions and normals.
struct GltfMorphTarget {
  std::optional<AccessorView> positions, normals;
};

// Four joints per vertex and their weights.
struct GltfJoints {
  AccessorView joints, weights;
};

// A checked primitive: accessors of its attributes, indices and morph targets.
struct GltfPrimitive {
  GltfTopology topology = GltfTopology::triangles;
  AccessorView positions;
  std::optional<AccessorView> normals, indices, colors;
  std::map<int, AccessorView> uvs;  // by n of TEXCOORD_n
  std::vector<GltfJoints> joints;   // JOINTS_0, JOINTS_1, … with their weights
  std::vector<GltfMorphTarget> targets;
  std::optional<uint32_t> material;
  std::shared_ptr<const DracoMesh> decoded;  // storage behind the views if [2] is used; else null

  // Number of triangles by the counts of the accessors, degenerate ones included.
  uint64_t triangle_count() const;
  // Returns the vertices of triangle i, counter-clockwise seen from its front [1] §3.7.2.1.
  std::array<uint32_t, 3> triangle(uint64_t i) const;
};

// Reads a primitive. Returns nothing, with a warning, for points, lines and primitives without
// positions. Fails if accessors have the wrong type or different counts, an index is out of range,
// or compressed data is broken.
std::optional<GltfPrimitive> read_gltf_primitive(const JsonNode& primitive, GltfBuffers& buffers,
                                                 WarningLog& warnings);

}  // namespace troffer
