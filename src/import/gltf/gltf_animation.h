// glTF animations, evaluated at one moment. The result replaces transforms and morph weights of
// nodes (gltf_nodes.h, gltf.cpp).
// References: [1] Khronos, glTF 2.0 Specification, §3.11 (Animations) and appendix C (Animation
//   Sampler Interpolation Modes).
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/log.h"
#include "import/gltf/gltf_accessor.h"
#include "import/gltf/gltf_json.h"

namespace troffer {

// Animated properties of a node, which replace the node's own members of the same names.
struct GltfNodePose {
  std::optional<std::array<double, 3>> translation, scale;
  std::optional<std::array<double, 4>> rotation;  // x y z w, of any length
  std::optional<std::vector<double>> weights;

  bool moves() const { return translation || rotation || scale; }
};

using GltfPoses = std::map<uint32_t, GltfNodePose>;  // by node

// Returns the poses of the named animation, or of the first one, `time` seconds after its start.
// Before the first key the first value holds, after the last key the last one [1].
// Throws UsageError if there is no animation of that name, InputError if its data violates [1].
// Warns of targets that are not properties of a node.
GltfPoses gltf_poses(const JsonNode& root, const GltfBuffers& buffers, double time,
                     const std::optional<std::string>& animation, WarningLog& warnings);

}  // namespace troffer
