// Colours and numbers of Mitsuba's plugins that may be textures.
//
// References: [1] W. Jakob et al., "Mitsuba 3 documentation: Textures"; [2] W. Jakob, "Mitsuba 0.6
//   Documentation", §8.4 (Textures).
#pragma once

#include <string>
#include <string_view>

#include "import/mitsuba_tree.h"
#include "import/texture_loader.h"
#include "scene/scene.h"

namespace troffer {

class MitsubaTextures {
 public:
  // Both must outlive this.
  MitsubaTextures(Scene& scene, const MitsubaTree& tree);

  // A colour, a texture or a reference to one. What has no counterpart is one colour, with a
  // warning that names it. InputError: values that cannot be used.
  ColorInput color(const MitsubaNode& plugin, std::initializer_list<std::string_view> names,
                   Rgb fallback);
  FloatInput real(const MitsubaNode& plugin, std::initializer_list<std::string_view> names,
                  float fallback);
  // A colour of any size, 0 where there is none.
  ColorInput real_color(const MitsubaNode& plugin, std::string_view name);
  // Of an area light.
  ColorInput emission(const MitsubaNode& parameter);
  // A texture of numbers, not colours (normal maps, heights): no_texture where it is not there.
  ColorInput raw(const MitsubaNode& texture);

  // A texture of which every value v of every channel is v / (1 - f + f v): Lambertian reflection
  // under a coat that is darker than Mitsuba's, made equal to it (mitsuba_bsdf.cpp).
  int32_t with_brightened_texels(int32_t texture, float f);

 private:
  Scene& scene_;
  const MitsubaTree& tree_;
  TextureLoader loader_;
  int depth_ = 0;

  ColorInput value(const MitsubaNode& node, bool is_emission, bool is_raw);
  ColorInput texture(const MitsubaNode& node, bool is_raw);
  int32_t bitmap(const MitsubaNode& node, bool is_raw);
  ColorInput checkerboard(const MitsubaNode& node);
  ColorInput scaled(const MitsubaNode& node, bool is_raw);
  Rgb plain(const MitsubaNode& node, std::string_view name, Rgb fallback);
  void set_coordinates(const MitsubaNode& node, Texture& look);
  int32_t append(Texture texture);
};

}  // namespace troffer
