// Converts pbrt materials to scene materials, each when a shape first uses it. Used by
// PbrtInterpreter and PbrtPlacer.
//
// References: [1] pbrt-v4 Input File Format, section "Materials", pbrt.org/fileformat-v4.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "import/pbrt/pbrt_texture.h"

namespace troffer {

// A Material or MakeNamedMaterial directive; several shapes may share one.
struct PbrtMaterial {
  std::string name, type;
  PbrtParams params;
  std::vector<std::shared_ptr<const PbrtMaterial>> mixed;  // the two materials of a mix
  int depth = 0;                                           // nesting depth of mixes
  int32_t index = -1;                                      // in Scene::materials; -1 until made
  // Indices of copies, by alpha texture, alpha factor and absorption.
  std::map<std::array<float, 5>, uint32_t> copies;

  // True for an interface between media, which light passes unchanged.
  bool is_interface() const { return type.empty() || type == "none" || type == "interface"; }
};

class PbrtMaterials {
 public:
  PbrtMaterials(Scene& scene, std::string folder)
      : textures(scene, std::move(folder)), scene_(scene) {}

  PbrtTextures textures;

  // Returns the index in Scene::materials. Throws InputError for parameters of the wrong type and
  // unknown textures.
  uint32_t index_of(PbrtMaterial& material);
  // Returns the index of a copy with coverage `alpha`, around a medium with that absorption per
  // metre.
  uint32_t index_of_copy(PbrtMaterial& material, const std::optional<FloatInput>& alpha,
                         Rgb absorption);
  // Returns the index of a copy for meshes whose (u,v) run clockwise. pbrt's y of a normal map is
  // normal × x there too (its materials.h, NormalMap), but the scene's runs up the image. The copy
  // inverts the green channel.
  uint32_t with_flipped_normal_map(uint32_t material);
  // Absorption of a medium per metre. Unsupported media add a warning and absorb nothing.
  Rgb read_medium(const std::string& type, const PbrtParams& params);

 private:
  Scene& scene_;
  std::map<uint32_t, uint32_t> turned_;  // by material

  Material make(const PbrtMaterial& material);
  // The next two read parameters whose names begin with `prefix`.
  void read_roughness(const PbrtParams& params, Material& m, const std::string& prefix = "");
  void read_conductor(const PbrtParams& params, Material& m, const std::string& prefix = "");
  Material make_coated_conductor(const PbrtParams& params);
  Material make_subsurface(const PbrtParams& params);
  void warn_of_coat_medium(const PbrtParams& params);
  Material make_mix(const PbrtMaterial& material);
  float read_ior(const PbrtParams& params, const char* name);
  void read_bump(const PbrtParams& params, Material& m);
};

// True if any input of the material depends on (u,v).
bool is_textured(const Material& material);

}  // namespace troffer
