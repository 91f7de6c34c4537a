// What the Phong-era terms of MTL materials become here.
//
// The format names colours, not how they combine, so this is a choice [1]:
// - Pr or Pm (the physically based extension): metallic_roughness with base colour Kd.
// - illum 3, 5, 8 (mirror): metallic_roughness with base colour Kd + Ks, metallic by the share of
// Ks.
// - d < 1 (or Tr > 0): with illum 6, 7, solid glass of index Ni; else a thin sheet that lets the
//   share 1 - d through. map_d is the share of rays that meet the surface.
// - illum 2, or none given, with Ks: coated diffuse of base colour Kd, whose 4 % reflection is
//   scaled by Ks (1 = all of it) and map_Ks, alpha = sqrt(2 / (Ns map_Ns + 2)).
// - else diffuse Kd.
// With Pr or Pm, aniso and anisor: widths alpha / a and alpha a with a = sqrt(1 - .9 aniso) [2];
// Ps: white fibres of that share.
// Where map_Kd is given and Kd is black or absent, the image alone counts; so map_Ke without Ke.
//
// References: [1] Wavefront Technologies, "MTL material format", 1995, and the physically based
//   extension by Exocortex. [2] Burley, "Physically Based Shading at Disney", 2012.
#pragma once

#include <string>

#include "import/mesh/mtl.h"
#include "import/texture_loader.h"
#include "scene/scene.h"

namespace troffer {

// A material of the scene, and what it emits.
struct MtlConverted {
  Material material;
  Rgb emission;
  int32_t emission_texture = no_texture;
};
MtlConverted convert_mtl(const MtlMaterial& mtl, const std::string& folder, TextureLoader& loader,
                         Scene& scene);

}  // namespace troffer
