// Gloss of two widths, as formats with u and v tell it -> Material::anisotropy.
#pragma once

#include "scene/scene.h"

namespace troffer {

// Sets roughness and anisotropy by the roughness along u and along v, which m.roughness_meaning
// explains.
void set_two_widths(Material& m, float along_u, float along_v);

// The same where one or both are images: exact where both are looked up alike, texel by texel.
// False, and nothing changes, for textures that are no images of one size and look-up.
bool set_two_widths(Scene& scene, Material& m, const FloatInput& along_u,
                    const FloatInput& along_v);

}  // namespace troffer
