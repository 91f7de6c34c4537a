// Conversion of gloss with different roughness along u and v to Material::roughness and anisotropy.
// Used by the importers of pbrt, Mitsuba and MTL.
#pragma once

#include "scene/scene.h"

namespace troffer {

// Sets roughness and anisotropy from the roughness along u and along v, in the meaning of
// m.roughness_meaning.
void set_anisotropic_roughness(Material& m, float along_u, float along_v);

// Sets them from images, texel by texel. Exact if both images have the same size and look-up;
// otherwise, or for textures that are not images, returns false and changes nothing.
bool set_anisotropic_roughness(Scene& scene, Material& m, const FloatInput& along_u,
                               const FloatInput& along_v);

}  // namespace troffer
