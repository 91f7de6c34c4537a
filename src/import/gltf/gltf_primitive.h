// glTF mesh primitives as the file has them: accessors, checked against each other.
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

// What a morph target adds to positions and normals.
struct GltfMorphTarget {
  std::optional<AccessorView> positions, normals;
};

// Four joints of each vertex, and how much each counts.
struct GltfJoints {
  AccessorView joints, weights;
};

struct GltfPrimitive {
  GltfTopology topology = GltfTopology::triangles;
  AccessorView positions;
  std::optional<AccessorView> normals, indices, colors;
  std::map<int, AccessorView> uvs;  // by the n of TEXCOORD_n
  std::vector<GltfJoints> joints;   // JOINTS_0, JOINTS_1 …
  std::vector<GltfMorphTarget> targets;
  std::optional<uint32_t> material;
  std::shared_ptr<const DracoMesh> decoded;  // holds what the views show, where it was compressed

  // As the counts say, degenerate ones included.
  uint64_t triangle_count() const;
  // The vertices of triangle i, front first [1] §3.7.2.1.
  std::array<uint32_t, 3> triangle(uint64_t i) const;
};

// Nothing (and a warning) for points, lines and primitives without positions. Fails where
// accessors have the wrong type, their counts differ, an index is out of range, or compressed data
// is broken.
std::optional<GltfPrimitive> read_gltf_primitive(const JsonNode& primitive, GltfBuffers& buffers,
                                                 WarningLog& warnings);

}  // namespace troffer
