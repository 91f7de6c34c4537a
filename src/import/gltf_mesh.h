// glTF mesh primitives -> meshes in world space.
// References: [1] Khronos, glTF 2.0 Specification, §3.7 (Geometry).
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "base/log.h"
#include "base/transform.h"
#include "import/gltf_accessor.h"
#include "import/gltf_json.h"
#include "import/recentre.h"
#include "scene/scene.h"

namespace troffer {

enum class GltfTopology : uint8_t { triangles, strip, fan };

// The accessors of one primitive, checked against each other.
struct GltfPrimitive {
  GltfTopology topology = GltfTopology::triangles;
  AccessorView positions;
  std::optional<AccessorView> normals, indices;
  std::map<int, AccessorView> uvs;  // by the n of TEXCOORD_n
  std::optional<uint32_t> material;

  // As the counts say, degenerate ones included.
  uint64_t triangle_count() const;
};

// Nothing (and a warning) for points, lines and primitives without positions. Fails where
// accessors have the wrong type, their counts differ, or an index is out of range.
std::optional<GltfPrimitive> read_gltf_primitive(const JsonNode& primitive, GltfBuffers& buffers,
                                                 WarningLog& warnings);

// The primitive in world space, with the vertices that its triangles use. Triangles without area
// or with vertices that are not finite are left out, with a warning. Under a mirroring transform
// triangles are turned round, so that the front stays the front [1] §3.7.4; a mesh all of whose
// normals contradict its winding is wound by them, with a warning. `uv_set`: which TEXCOORD_n
// becomes Mesh::uvs (none if it is not there). Counts its triangles into `bounds`.
Mesh make_gltf_mesh(const GltfPrimitive& primitive, const Affine& world_from_node, int uv_set,
                    WarningLog& warnings, PlacedBounds& bounds);

}  // namespace troffer
