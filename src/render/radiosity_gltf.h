// Export of a radiosity solution as glTF, for any viewer: mesh and light.
//
// Colours are linear, per vertex and unlit (KHR_materials_unlit): (radiosity + emission, pi L) ×
// exposure, cut at 1. Radiosity is the element's reflectance times the irradiance interpolated at
// the corner, plus the ambient estimate where light arrives. `exposure` is in asset.extras; it maps
// the 95 % quantile of radiosity over area to 1. Each side that light reaches has its own
// triangles; other sides are left out.
//
// The second scene of the file, "elements", adds the elements' outlines as lines.
// References: [1] Khronos Group, "glTF 2.0 Specification", 2021. [2] "KHR_materials_unlit".
#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/solution.h"

namespace troffer {

enum class GltfContainer {
  text,   // .gltf, with the buffer embedded in base64
  binary  // .glb
};

// Returns the file. glTF has y up and is right-handed; if the scene has a camera, its up axis and
// handedness determine the conversion.
std::vector<uint8_t> radiosity_gltf(const Scene& scene, const RadiositySolution& solution,
                                    GltfContainer container);

}  // namespace troffer
