// Textures: images and products of textures, looked up by (u,v).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/rgb.h"
#include "base/vec.h"

namespace troffer {

enum class WrapMode : uint8_t { repeat, clamp, mirror, black };
enum class TextureKind : uint8_t { constant, image, product };

// (0,0) of the (u,v) square is the image's top left texel corner, v down (glTF's rule); importers
// of formats whose v points up set uv_scale.y = -1 and uv_offset.y = 1.
struct Texture {
  std::string name;
  TextureKind kind = TextureKind::constant;
  Rgb value{1};                         // constant: the value; image: factor on every texel
  uint32_t factor_a = 0, factor_b = 0;  // product: two textures of lower index

  // image
  int width = 0, height = 0;
  int channels = 0;                 // 1 grey, 2 grey+alpha, 3 rgb, 4 rgb+alpha
  std::vector<uint8_t> texels8;     // row-major, top row first; either this …
  std::vector<float> texels_float;  // … or this, linear
  bool is_srgb = true;              // texels8 carry the sRGB transfer function (not in alpha)
  bool is_inverted = false;         // pbrt: 1 - value
  bool is_filtered = true;          // bilinear, else nearest
  WrapMode wrap_u = WrapMode::repeat, wrap_v = WrapMode::repeat;
  Vec2 uv_scale{1, 1}, uv_offset{0, 0};  // lookup at uv * scale + offset
  float uv_rotation_rad = 0;             // KHR_texture_transform: rotation before the scale
};

struct TextureValue {
  Rgb rgb{1};
  float alpha = 1;
};

// Value at (u,v). NaN and infinite coordinates read as (0,0).
TextureValue evaluate(const std::vector<Texture>& textures, uint32_t texture, const Vec2& uv);

// Asks for the memory that evaluate() will read, so that it is there when many others have been
// asked for meanwhile. Changes nothing else.
void prefetch(const std::vector<Texture>& textures, uint32_t texture, const Vec2& uv);

}  // namespace troffer
