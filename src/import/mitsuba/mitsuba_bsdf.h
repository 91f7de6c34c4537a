// Converts Mitsuba's bsdf plugins to materials. Used by MitsubaReader. A bsdf becomes one scene
// material on its first use; approximations add warnings.
//
// References: [1] W. Jakob et al., "Mitsuba 3 documentation: BSDFs"; [2] W. Jakob, "Mitsuba 0.6
//   Documentation", §8.2 (Surface scattering models).
#pragma once

#include <array>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "import/mitsuba/mitsuba_texture.h"

namespace troffer {

class MitsubaBsdfs {
 public:
  // All arguments must outlive this object.
  MitsubaBsdfs(Scene& scene, const MitsubaTree& tree, MitsubaTextures& textures)
      : scene_(scene), tree_(tree), textures_(textures) {}

  // Returns the index in Scene::materials of a <bsdf>, which is converted on its first use. Returns
  // nothing for `null`, which light passes unchanged. Throws InputError for unusable parameters.
  std::optional<uint32_t> index_of(const MitsubaNode& bsdf);
  // Returns the index of a copy with a medium inside of that absorption per metre.
  uint32_t with_medium(uint32_t material, Rgb absorption);
  // Returns the material of shapes without bsdf: grey, or black if they emit.
  uint32_t default_index(bool is_emitting);
  // Returns the material of emitting shapes that are otherwise invisible: a pane of index 1.
  uint32_t invisible_index();

 private:
  Scene& scene_;
  const MitsubaTree& tree_;
  MitsubaTextures& textures_;
  // Materials by bsdf and, if it shows attributes of a shape, by these attributes.
  std::map<std::pair<const MitsubaNode*, const MitsubaAttributes*>, std::optional<uint32_t>> made_;
  std::map<std::array<float, 4>, uint32_t> with_medium_;
  std::optional<uint32_t> grey_, black_, nothing_;
  int depth_ = 0;

  std::optional<Material> convert(const MitsubaNode& node);
  std::optional<Material> convert_simple(const MitsubaNode& node);
  std::optional<Material> nested(const MitsubaNode& node);
  Material diffuse(const MitsubaNode& node);
  Material conductor(const MitsubaNode& node);
  Material dielectric(const MitsubaNode& node);
  Material plastic(const MitsubaNode& node);
  Material principled(const MitsubaNode& node);
  Material phong(const MitsubaNode& node);
  std::optional<Material> masked(const MitsubaNode& node);
  // A bsdf within `blendbsdf` or `mixturebsdf`, and its share.
  struct Part {
    double share = 0;
    std::optional<Material> material;  // none: light passes unchanged
  };
  std::vector<Part> parts_of(const MitsubaNode& node);
  std::optional<Material> blended(const MitsubaNode& node);
  std::optional<Material> mixed(const MitsubaNode& node);
  std::optional<Material> blended_by(const MitsubaNode& node, const FloatInput& weight,
                                     std::vector<Part>& parts);
  std::optional<Material> sum_of(const MitsubaNode& node, std::vector<Part> parts);
  std::optional<Material> with_mask(const MitsubaNode& node, Material m, const FloatInput& share);
  std::optional<Material> coated(const MitsubaNode& node);
  std::optional<Material> bumped(const MitsubaNode& node);
  std::optional<Material> two_sided(const MitsubaNode& node);
  void read_alpha(const MitsubaNode& node, Material& m);
  void approximate(const MitsubaNode& node, const std::string& how);
};

}  // namespace troffer
