// pbrt materials -> scene materials, made when a shape first wears them.
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

// What a Material or MakeNamedMaterial directive says; several shapes share one.
struct PbrtMaterial {
  std::string name, type;
  PbrtParams params;
  std::vector<std::shared_ptr<const PbrtMaterial>> mixed;  // the two of a mix
  int depth = 0;                                           // of mixes within it
  int32_t index = -1;                                      // in Scene::materials, once made
  // Copies, by texture × factor of alpha and by what is absorbed inside.
  std::map<std::array<float, 5>, uint32_t> copies;

  // An interface between media: not there for light.
  bool is_interface() const { return type.empty() || type == "none" || type == "interface"; }
};

class PbrtMaterials {
 public:
  PbrtMaterials(Scene& scene, std::string folder)
      : textures(scene, std::move(folder)), scene_(scene) {}

  PbrtTextures textures;

  // Index in Scene::materials. InputError: parameters of wrong type, unknown textures.
  uint32_t index_of(PbrtMaterial& material);
  // The same material, met by the share `alpha` of rays, around a medium that absorbs so much per
  // metre.
  uint32_t index_of_copy(PbrtMaterial& material, const std::optional<FloatInput>& alpha,
                         Rgb absorption);
  // The material for meshes whose (u,v) run clockwise. pbrt's y of a normal map is normal × x there
  // too (its materials.h, NormalMap), the scene's runs up the image: green is turned round.
  uint32_t with_turned_normals(uint32_t material);
  // What a medium absorbs per metre; nothing of those that are left out, with a warning.
  Rgb read_medium(const std::string& type, const PbrtParams& params);

 private:
  Scene& scene_;
  std::map<uint32_t, uint32_t> turned_;  // by material

  Material make(const PbrtMaterial& material);
  // Of parameters whose names begin with `prefix`.
  void read_roughness(const PbrtParams& params, Material& m, const std::string& prefix = "");
  void read_conductor(const PbrtParams& params, Material& m, const std::string& prefix = "");
  Material make_coated_conductor(const PbrtParams& params);
  Material make_subsurface(const PbrtParams& params);
  void warn_of_coat_medium(const PbrtParams& params);
  Material make_mix(const PbrtMaterial& material);
  float read_ior(const PbrtParams& params, const char* name);
  void read_bump(const PbrtParams& params, Material& m);
};

// Whether anything in that material depends on (u,v).
bool is_textured(const Material& material);

}  // namespace troffer
