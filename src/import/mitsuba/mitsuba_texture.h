// Colours and numbers of Mitsuba's plugins that may be textures. Used by MitsubaBsdfs and for
// lights.
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
  // Both must outlive this object.
  MitsubaTextures(Scene& scene, const MitsubaTree& tree);

  // Returns a colour, a texture, or the target of a reference to one. Unsupported textures become
  // one colour, with a warning. Throws InputError for unusable values.
  ColorInput color(const MitsubaNode& plugin, std::initializer_list<std::string_view> names,
                   Rgb fallback);
  // Returns a number; of a colour, its luminance.
  FloatInput real(const MitsubaNode& plugin, std::initializer_list<std::string_view> names,
                  float fallback);
  FloatInput real(const MitsubaNode& parameter);
  // Returns a colour of any size; 0 if it is not given.
  ColorInput real_color(const MitsubaNode& plugin, std::string_view name);
  ColorInput color(const MitsubaNode& parameter);
  // Returns the emission of a light.
  ColorInput emission(const MitsubaNode& parameter);
  // Returns three numbers per texel, as of a normal map.
  ColorInput vector(const MitsubaNode& parameter);

  // Sets the shape whose attributes mesh_attribute textures show from here on. With null, these
  // textures are black, with a warning.
  void set_attributes(MitsubaAttributes* attributes) { attributes_ = attributes; }
  const MitsubaAttributes* attributes() const { return attributes_; }
  // Number of attribute textures requested for that shape.
  size_t attribute_uses() const { return attributes_ ? attributes_->uses() : 0; }

  // Returns a texture with every value v replaced by v / (1 - f + f v). It makes our coat over a
  // Lambertian base as bright as Mitsuba's (mitsuba_bsdf.cpp).
  int32_t with_brightened_texels(int32_t texture, float f);

 private:
  Scene& scene_;
  const MitsubaTree& tree_;
  TextureLoader loader_;
  int depth_ = 0;

  // Rules for the parameter that is being read.
  SpectrumUse use_ = SpectrumUse::reflectance;
  bool is_number_ = false;
  MitsubaAttributes* attributes_ = nullptr;
  std::map<int32_t, int32_t> grey_;  // texture -> texture of its luminance

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
