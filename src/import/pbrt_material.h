// pbrt materials -> scene materials, made when a shape first wears them.
//
// References: [1] pbrt-v4 Input File Format, section "Materials", pbrt.org/fileformat-v4.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "import/pbrt_texture.h"

namespace troffer {

// What a Material or MakeNamedMaterial directive says; several shapes share one.
struct PbrtMaterial {
  std::string name, type;
  PbrtParams params;
  std::vector<std::shared_ptr<const PbrtMaterial>> mixed;    // the two of a mix
  int depth = 0;                                             // of mixes within it
  int32_t index = -1;                                        // in Scene::materials, once made
  std::map<std::pair<int32_t, float>, uint32_t> with_alpha;  // copies, by texture × factor

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
  // The same material, met by the share `alpha` of rays.
  uint32_t index_with_alpha(PbrtMaterial& material, const FloatInput& alpha);

 private:
  Scene& scene_;

  Material make(const PbrtMaterial& material);
  // Of parameters whose names begin with `prefix`.
  void read_roughness(const PbrtParams& params, Material& m, const std::string& prefix = "");
  void read_conductor(const PbrtParams& params, Material& m, const std::string& prefix = "");
  Material make_coated_conductor(const PbrtParams& params);
  Material make_mix(const PbrtMaterial& material);
  float read_ior(const PbrtParams& params);
};

// Whether anything in that material depends on (u,v).
bool is_textured(const Material& material);

}  // namespace troffer
