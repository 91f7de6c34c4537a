// Gloss of two widths, as formats with u and v tell it -> Material::anisotropy.
#pragma once

#include "scene/material.h"

namespace troffer {

// Sets roughness and anisotropy by the roughness along u and along v, which m.roughness_meaning
// explains.
void set_two_widths(Material& m, float along_u, float along_v);

}  // namespace troffer
