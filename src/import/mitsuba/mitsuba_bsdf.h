// Mitsuba's bsdf plugins -> materials.
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
  // All must outlive this.
  MitsubaBsdfs(Scene& scene, const MitsubaTree& tree, MitsubaTextures& textures)
      : scene_(scene), tree_(tree), textures_(textures) {}

  // Index in Scene::materials of what a <bsdf> says, made when it is first asked for; nothing for
  // surfaces that are not there for light (null). InputError: parameters that cannot be used.
  std::optional<uint32_t> index_of(const MitsubaNode& bsdf);
  // That material with a medium inside that absorbs so much per metre.
  uint32_t with_medium(uint32_t material, Rgb absorption);
  // Of shapes without bsdf: grey; black where they emit.
  uint32_t default_index(bool is_emitting);
  // Of what emits and is otherwise not there: a pane that neither reflects nor takes anything.
  uint32_t nothing_index();

 private:
  Scene& scene_;
  const MitsubaTree& tree_;
  MitsubaTextures& textures_;
  // Materials by bsdf and, where it shows attributes of a shape, by these.
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
  // A bsdf within `blendbsdf` and `mixturebsdf`, and its share.
  struct Part {
    double share = 0;
    std::optional<Material> material;  // none: light goes on
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
