// MTL material libraries, as they are written. obj.cpp reads them; mtl_convert.h converts them to
// materials of the scene.
//
// References: Wavefront Technologies, "MTL material format", 1995, and the physically based
//   extension by Exocortex.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "base/log.h"
#include "base/rgb.h"
#include "base/vec.h"

namespace troffer {

// One image of a material, with its options.
struct MtlMap {
  std::string file;  // relative to the scene's folder; empty: no image
  Vec2 scale{1, 1}, offset{0, 0};
  bool is_clamped = false;
  float strength = 1;         // -bm
  float base = 0, gain = 1;   // -mm
  char channel = 0;           // -imfchan: r g b m l; 0: not given
  bool is_turbulent = false;  // -t
  bool is_linear = false;     // -colorspace linear
};

struct MtlMaterial {
  std::string name;
  std::optional<Rgb> diffuse;                // Kd
  Rgb specular{0};                           // Ks
  std::optional<Rgb> emission;               // Ke
  float exponent = 0;                        // Ns
  float opacity = 1;                         // d, else 1 - Tr
  bool has_dissolve = false;                 // d is given
  std::optional<Rgb> filter;                 // Tf: colour of transmitted light
  float ior = 1.5f;                          // Ni
  int illumination = -1;                     // illum; -1: not given
  std::optional<float> roughness, metallic;  // Pr, Pm
  float coat = 0, coat_roughness = 0;        // Pc, Pcr
  float sheen = 0;                           // Ps
  float anisotropy = 0, turn = 0;            // aniso; anisor, in whole turns
  // True if Blender wrote the library: its map_Ns holds roughness.
  bool is_of_blender = false;
  MtlMap map_diffuse, map_specular, map_emission, map_opacity, map_roughness, map_metallic,
      map_exponent, map_normal, map_bump;
};

using MtlLibrary = std::map<std::string, MtlMaterial, std::less<>>;

// Reads a library into `library`. A later material replaces an earlier one of the same name.
// `subfolder` is the library's folder relative to the scene's folder ("" or ending in '/'); image
// paths start there. Throws InputError for malformed numbers.
void read_mtl(const std::string& path, const std::string& subfolder, MtlLibrary& library,
              WarningLog& warnings);

}  // namespace troffer
