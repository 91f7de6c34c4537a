// Textures times factors as plain images, by a look (texture_look.h) that says size and placing.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "export/texture_look.h"
#include "scene/scene.h"

namespace troffer {

// A picture file's texels, row 0 on top, channels interleaved: 8 bits each in the file's code, or
// linear floats.
struct BakedImage {
  int width = 1, height = 1, channels = 3;
  std::vector<uint8_t> texels8;
  std::vector<float> texels_float;
  bool is_srgb = true;  // colours carry the sRGB transfer function in the file
  float scale = 1;      // factor on the PNG's values: where some are above 1

  bool has_alpha() const { return channels == 2 || channels == 4; }
};

// A change of every value of a colour's channels; none where empty.
using ColorChange = std::function<float(float)>;

// value × texture of a colour, changed; with `alpha` (null: none) as a fourth channel, without its
// value.
BakedImage baked_color(const Scene& scene, const ColorInput& input, const Texture& look,
                       const FloatInput* alpha, const ColorChange& change = {});
// The same at one place.
Rgb color_at(const Scene& scene, const ColorInput& input, const Vec2& uv,
             const ColorChange& change = {});
// One channel of numbers, times the value, within [0,1], raised to `power`, as grey; not sRGB.
BakedImage baked_number(const Scene& scene, const FloatInput& input, const Texture& look,
                        float power);
// The same as it is, of any size and sign: for files of floats.
BakedImage baked_heights(const Scene& scene, const FloatInput& input, const Texture& look);
// 1 where an alpha mask covers, 0 in its holes; the look's texels are told apart.
BakedImage baked_holes(const Scene& scene, const Material& material, const Texture& look);
// The number as the alpha of a white image (glTF's numbers in the fourth channel).
BakedImage as_alpha(const BakedImage& number);
// Numbers in three channels: 0 in red, `green` and `blue` (glTF's roughness and metal).
BakedImage baked_pair(const Scene& scene, const FloatInput& green, float green_power,
                      const FloatInput& blue, const Texture& look);
// Texels as they are (glTF's normals, directions of a grain).
BakedImage baked_raw(const Scene& scene, uint32_t texture, const Texture& look);
// Normals of a map whose x and y are multiplied by those factors.
BakedImage baked_normals(const Scene& scene, uint32_t texture, const Texture& look,
                         const Vec2& factors);

// Warns of what neither format is written with (is_gltf: or glTF alone) of a material.
void tell_what_is_left_out(const Scene& scene, const Material& material, bool is_gltf,
                           WarningLog& warnings);

std::vector<uint8_t> png_of(const BakedImage& image);
// Whether values lie outside of what a PNG holds at `scale`.
bool needs_floats(const BakedImage& image);
// Linear, three channels.
std::vector<uint8_t> pfm_of(const BakedImage& image);

}  // namespace troffer
