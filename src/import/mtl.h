// MTL material libraries, and what their Phong-era terms become here.
//
// The format names colours, not how they combine, so this is a choice [1]:
// - Pr or Pm (the physically based extension): metallic_roughness with base colour Kd.
// - illum 3, 5, 8 (mirror): metallic_roughness with base colour Kd + Ks, metallic by the share of
// Ks.
// - d < 1 (or Tr > 0): with illum 6, 7, solid glass of index Ni; else a thin sheet that lets the
//   share 1 - d through. map_d is the share of rays that meet the surface.
// - illum 2, or none given, with Ks: coated diffuse of base colour Kd, whose 4 % reflection is
//   scaled by Ks (1 = all of it) and map_Ks, alpha = sqrt(2 / (Ns + 2)).
// - aniso and anisor, with Pr or Pm: widths alpha / a and alpha a with a = sqrt(1 - .9 aniso) [2];
//   Ps: white fibres of that share.
// - else diffuse Kd.
// Where map_Kd is given and Kd is black or absent, the image alone counts; so map_Ke without Ke.
//
// References: [1] Wavefront Technologies, "MTL material format", 1995, and the physically based
//   extension by Exocortex. [2] Burley, "Physically Based Shading at Disney", 2012.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "base/log.h"
#include "import/texture_loader.h"
#include "scene/scene.h"

namespace troffer {

// One image with its options.
struct MtlMap {
  std::string file;  // relative to the scene's folder; "" = none
  Vec2 scale{1, 1}, offset{0, 0};
  bool is_clamped = false;
  float strength = 1;  // -bm
};

struct MtlMaterial {
  std::string name;
  std::optional<Rgb> diffuse;                // Kd
  Rgb specular{0};                           // Ks
  std::optional<Rgb> emission;               // Ke
  float exponent = 0;                        // Ns
  float opacity = 1;                         // d, 1 - Tr
  std::optional<Rgb> filter;                 // Tf: colour of what goes through
  float ior = 1.5f;                          // Ni
  int illumination = -1;                     // illum; -1 = not given
  std::optional<float> roughness, metallic;  // Pr, Pm
  float coat = 0, coat_roughness = 0;        // Pc, Pcr
  float sheen = 0;                           // Ps
  float anisotropy = 0, turn = 0;            // aniso, anisor: of a whole turn
  MtlMap map_diffuse, map_specular, map_emission, map_opacity, map_roughness, map_metallic,
      map_normal, map_bump;
};

using MtlLibrary = std::map<std::string, MtlMaterial, std::less<>>;

// Reads a library into `library`; of two materials with one name the later counts. `subfolder` is
// the library's folder relative to the scene's ("" or ending in '/'), for its images.
// InputError: malformed numbers.
void read_mtl(const std::string& path, const std::string& subfolder, MtlLibrary& library,
              WarningLog& warnings);

// A material of the scene, and what it emits.
struct MtlConverted {
  Material material;
  Rgb emission;
  int32_t emission_texture = no_texture;
};
MtlConverted convert_mtl(const MtlMaterial& mtl, const std::string& folder, TextureLoader& loader,
                         const std::vector<Texture>& textures, WarningLog& warnings);

}  // namespace troffer
