// A radiosity solution as a glTF file, to be looked at in any viewer: mesh and light.
//
// Colours are linear, per vertex and unlit (KHR_materials_unlit): (radiosity + what is emitted,
// pi L) × exposure, cut at 1. Radiosity is the element's reflectance times the irradiance
// interpolated at the corner, with the ambient estimate where light arrives. `exposure` is in
// asset.extras; it brings the brightest 5 % of the area to 1. Each side that light reaches has
// triangles of its own; other sides are left out.
//
// The second scene of the file, "elements", adds the elements' outlines as lines.
// References: [1] Khronos Group, "glTF 2.0 Specification", 2021. [2] "KHR_materials_unlit".
#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/solution.h"

namespace troffer {

enum class GltfContainer {
  text,   // .gltf, the buffer embedded in base64
  binary  // .glb
};

// Not every world is glTF's (y up, right-handed): where the scene has a camera, its up axis and its
// handedness tell how to turn it.
std::vector<uint8_t> radiosity_gltf(const Scene& scene, const RadiositySolution& solution,
                                    GltfContainer container);

}  // namespace troffer
