// Conversion of MTL materials to materials of the scene.
//
// The format names colours but not how they combine, so the mapping is a choice [1]:
// - Pr or Pm (the physically based extension): metallic_roughness with base colour Kd.
// - illum 3, 5, 8 (mirror): metallic_roughness with base colour Kd + Ks, metallic the share of Ks.
// - d < 1 (or Tr > 0): with illum 6, 7, solid glass of index Ni; else a thin sheet that transmits
//   the share 1 - d. map_d is the coverage.
// - illum 2, or none given, with Ks: coated diffuse of base colour Kd, whose 4 % reflection is
//   scaled by Ks (1 = all of it) and map_Ks, alpha = sqrt(2 / (Ns map_Ns + 2)).
// - otherwise diffuse Kd.
//
// With Pr or Pm, aniso and anisor give widths alpha / a and alpha a with a = sqrt(1 - .9 aniso)
// [2], and Ps is white sheen. If map_Kd is given and Kd is black or absent, Kd counts as 1;
// likewise Ke with map_Ke.
//
// References: [1] Wavefront Technologies, "MTL material format", 1995, and the physically based
//   extension by Exocortex.
//   [2] Burley, "Physically Based Shading at Disney", 2012.
#pragma once

#include <string>

#include "import/mesh/mtl.h"
#include "import/texture_loader.h"
#include "scene/scene.h"

namespace troffer {

// A material of the scene, and the radiance that it emits, W/(m² sr).
struct MtlConverted {
  Material material;
  Rgb emission;
  int32_t emission_texture = no_texture;
};
MtlConverted convert_mtl(const MtlMaterial& mtl, const std::string& folder, TextureLoader& loader,
                         Scene& scene);

}  // namespace troffer
