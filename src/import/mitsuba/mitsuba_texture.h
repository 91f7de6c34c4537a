// Colours and numbers of Mitsuba's plugins that may be textures.
//
// References: [1] W. Jakob et al., "Mitsuba 3 documentation: Textures"; [2] W. Jakob, "Mitsuba 0.6
//   Documentation", §8.4 (Textures).
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "import/mitsuba/mitsuba_attributes.h"
#include "import/mitsuba/mitsuba_spectrum.h"
#include "import/mitsuba/mitsuba_tree.h"
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
  // A number; the luminance where a colour is given.
  FloatInput real(const MitsubaNode& plugin, std::initializer_list<std::string_view> names,
                  float fallback);
  FloatInput real(const MitsubaNode& parameter);
  // A colour of any size, 0 where there is none.
  ColorInput real_color(const MitsubaNode& plugin, std::string_view name);
  ColorInput color(const MitsubaNode& parameter);
  // The emission of a light.
  ColorInput emission(const MitsubaNode& parameter);
  // Three numbers per place, as of a normal map.
  ColorInput vector(const MitsubaNode& parameter);

  // The shape whose attributes textures of type mesh_attribute show from now on; null: none, and
  // they are one colour, with a warning.
  void set_attributes(MitsubaAttributes* attributes) { attributes_ = attributes; }
  const MitsubaAttributes* attributes() const { return attributes_; }
  // Number of attributes shown of that shape.
  size_t attribute_uses() const { return attributes_ ? attributes_->uses() : 0; }

  // A texture of which every value v of every channel is v / (1 - f + f v): Lambertian reflection
  // under a coat that is darker than Mitsuba's, made equal to it (mitsuba_bsdf.cpp).
  int32_t with_brightened_texels(int32_t texture, float f);

 private:
  Scene& scene_;
  const MitsubaTree& tree_;
  TextureLoader loader_;
  int depth_ = 0;

  // Rules of the parameter that is being read.
  SpectrumUse use_ = SpectrumUse::reflectance;
  bool is_number_ = false;
  MitsubaAttributes* attributes_ = nullptr;
  std::map<int32_t, int32_t> grey_;  // textures and those of their luminance

  ColorInput value(const MitsubaNode& node, SpectrumUse use, bool is_number);
  ColorInput texture(const MitsubaNode& node);
  int32_t bitmap(const MitsubaNode& node);
  ColorInput checkerboard(const MitsubaNode& node);
  ColorInput scaled(const MitsubaNode& node);
  ColorInput attribute(const MitsubaNode& node);
  std::optional<Rgb> spectrum_plugin(const MitsubaNode& node);
  std::optional<Rgb> vector_value(const MitsubaNode& node);
  int32_t with_grey_texels(int32_t texture);
  Rgb plain(const MitsubaNode& node, std::string_view name, Rgb fallback);
  void set_coordinates(const MitsubaNode& node, Texture& look);
  int32_t append(Texture texture);
};

}  // namespace troffer
