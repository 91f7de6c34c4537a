// Animations of glTF: what they make of nodes at one moment.
// References: [1] Khronos, glTF 2.0 Specification, §3.11 (Animations) and appendix C
//   (Animation Sampler Interpolation Modes).
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

// What stands in place of the node's own members of these names.
struct GltfNodePose {
  std::optional<std::array<double, 3>> translation, scale;
  std::optional<std::array<double, 4>> rotation;  // x y z w, of any length
  std::optional<std::vector<double>> weights;

  bool moves() const { return translation || rotation || scale; }
};

using GltfPoses = std::map<uint32_t, GltfNodePose>;  // by node

// The poses `time` seconds into the animation of that name, or the first one: before an animation's
// first key its first value, after its last key its last [1]. UsageError where there is none of
// that name; InputError where the animation's data is not what [1] says. Targets that are no
// property of a node are told.
GltfPoses gltf_poses(const JsonNode& root, const GltfBuffers& buffers, double time,
                     const std::optional<std::string>& animation, WarningLog& warnings);

}  // namespace troffer
