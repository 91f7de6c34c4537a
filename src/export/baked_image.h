// Textures times factors as plain images.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "base/log.h"
#include "scene/scene.h"

namespace troffer {

// A picture file's texels, row 0 on top, channels interleaved: 8 bits each, or floats in [0,1] for
// files of 16 bits.
struct BakedImage {
  int width = 1, height = 1, channels = 3;
  std::vector<uint8_t> texels8;
  std::vector<float> texels_float;
  bool is_srgb = true;  // colours carry the sRGB transfer function
  float scale = 1;      // what its values are to be multiplied by: where some would be above 1
};

// A change of every value of a colour's channels; none where empty.
using ColorChange = std::function<float(float)>;

// value × texture of a colour, changed; with the texture's alpha (`with_alpha`) as a fourth
// channel.
BakedImage baked_color(const Scene& scene, const ColorInput& input, bool with_alpha,
                       const ColorChange& change = {});
// The same at one place.
// Warns of what neither format is written with (is_gltf: or glTF alone) of a material.
void tell_what_is_left_out(const Scene& scene, const Material& material, bool is_gltf,
                           WarningLog& warnings);

Rgb color_at(const Scene& scene, const ColorInput& input, const Vec2& uv,
             const ColorChange& change = {});
// One channel of numbers, times the value, raised to `power`, as grey; not sRGB.
BakedImage baked_number(const Scene& scene, const FloatInput& input, float power);
// Numbers in three channels: 0 in red, `green` and `blue` (glTF's roughness and metal).
BakedImage baked_pair(const Scene& scene, const FloatInput& green, float green_power,
                      const FloatInput& blue);
// Texels as they are (normal maps).
BakedImage baked_raw(const Scene& scene, uint32_t texture);

std::vector<uint8_t> png_of(const BakedImage& image);

// The image texture that says how an input's (u,v) are looked up: itself, or the first factor of a
// product that is an image; null where all is constant.
const Texture* image_of(const Scene& scene, int32_t texture);

}  // namespace troffer
