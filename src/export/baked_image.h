// Bakes textures times factors into plain images. A look (texture_look.h) determines size and
// placement. The glTF and pbrt exporters use it for every texture that they write.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "export/texture_look.h"
#include "scene/scene.h"

namespace troffer {

// Texels of a picture file, row 0 on top, channels interleaved: 8 bits in the file's encoding, or
// linear floats.
struct BakedImage {
  int width = 1, height = 1, channels = 3;
  std::vector<uint8_t> texels8;
  std::vector<float> texels_float;
  bool is_srgb = true;  // colour channels are sRGB encoded in the file
  float scale = 1;      // factor on the PNG's values, if some exceed 1

  bool has_alpha() const { return channels == 2 || channels == 4; }
};

// Function applied to every channel of a colour; may be empty.
using ColorChange = std::function<float(float)>;

// Returns value × texture of a colour, after `change`. `alpha`, unless null, becomes the fourth
// channel, without its value.
BakedImage baked_color(const Scene& scene, const ColorInput& input, const Texture& look,
                       const FloatInput* alpha, const ColorChange& change = {});
// Same at one position.
Rgb color_at(const Scene& scene, const ColorInput& input, const Vec2& uv,
             const ColorChange& change = {});
// Returns one channel times the value, clamped to [0,1] and raised to `power`, as a linear grey
// image.
BakedImage baked_number(const Scene& scene, const FloatInput& input, const Texture& look,
                        float power);
// Same without clamping, of any size and sign, for float files.
BakedImage baked_heights(const Scene& scene, const FloatInput& input, const Texture& look);
// Returns 1 where an alpha mask covers and 0 in its holes, texel by texel of the look.
BakedImage baked_holes(const Scene& scene, const Material& material, const Texture& look);
// Returns a white image with the number as alpha (glTF reads some numbers from the fourth channel).
BakedImage as_alpha(const BakedImage& number);
// Returns an image with 0 in red, `green` and `blue` (glTF's roughness and metallic).
BakedImage baked_pair(const Scene& scene, const FloatInput& green, float green_power,
                      const FloatInput& blue, const Texture& look);
// Returns unchanged texels (normals, directions of a grain).
BakedImage baked_raw(const Scene& scene, uint32_t texture, const Texture& look);
// Returns a normal map whose x and y are multiplied by `factors`.
BakedImage baked_normals(const Scene& scene, uint32_t texture, const Texture& look,
                         const Vec2& factors);

// Warns of properties of a material that neither format (or, if is_gltf, only glTF) can express.
void tell_what_is_left_out(const Scene& scene, const Material& material, bool is_gltf,
                           WarningLog& warnings);

std::vector<uint8_t> png_of(const BakedImage& image);
// True if values lie outside the range that a PNG with `scale` holds.
bool needs_floats(const BakedImage& image);
// Encodes three linear channels as PFM.
std::vector<uint8_t> pfm_of(const BakedImage& image);

}  // namespace troffer
