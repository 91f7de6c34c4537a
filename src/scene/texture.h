// Textures: images, products of textures, patterns and noise, looked up where a ray hits.
//
// A look-up has a footprint: what one ray stands for of the surface. Images answer with their mean
// over it, from levels of halved size, along the footprint's longer side by several probes; a point
// (a footprint of no size) gets the image itself, bilinear.
//
// References: [1] Akenine-Möller et al., "Texture Level of Detail Strategies for Real-Time Ray
//   Tracing", Ray Tracing Gems, 2019 (footprints by cones). [2] Perlin, "Improving Noise", SIGGRAPH
//   2002. [3] Pharr, Jakob & Humphreys, "Physically Based Rendering", 4th ed., ch. 10.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/rgb.h"
#include "base/transform.h"
#include "base/vec.h"

namespace troffer {

enum class WrapMode : uint8_t { repeat, clamp, mirror, black };
enum class TextureKind : uint8_t {
  constant,
  image,
  product,
  // Of pbrt [3]: patterns of `first` and `second`, …
  checks,
  dots,
  mix,
  // … and of noise
  fbm,
  wrinkled,
  windy,
  marble,
};
// What becomes the (u,v) of a look-up: the surface's own, or its second ones, or the place in
// space, by Texture::from_scene: as on a sphere or a cylinder around z, or the coordinates x and y;
// solid: all three (patterns and noise).
enum class TextureMapping : uint8_t { uv, second_uv, spherical, cylindrical, planar, solid };

// Where a texture is looked up, and over what.
struct TexturePlace {
  Vec2 uv;
  Vec2 axis_a, axis_b;  // sides of the footprint in (u,v); 0: a point
  // The same in the second set of texture coordinates.
  Vec2 uv_2, axis_2a, axis_2b;
  Vec3 position;    // from the scene's origin
  float width = 0;  // metres: shorter side of the footprint
  // Along it gloss is widest, where it is not the same all around: unit, in Frame(shading normal).
  Vec2 grain{1, 0};
  // The normal of a clear coat that does not lean with the base, in that frame: its x and y.
  Vec2 coat_normal{0, 0};

  TexturePlace() = default;
  // A point, for look-ups that know no more.
  TexturePlace(const Vec2& at) : uv(at), uv_2(at) {}
  TexturePlace(const Vec2& at, const Vec2& at_2) : uv(at), uv_2(at_2) {}
  operator const Vec2&() const { return uv; }
};

// A texture's factor, or what it is where there is none.
struct TextureOperand {
  Rgb value{1};
  int32_t texture = -1;  // of lower index
};

// An image at a fraction of its size.
struct TextureLevel {
  int width = 0, height = 0;
  size_t first = 0;       // among the levels' texels
  bool is_float = false;  // … levels_float or levels8
};

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

  // From build_levels(): halves, quarters … to one texel, in the image's own code but the smallest,
  // which are floats: rounding of bytes must not shift the mean.
  std::vector<TextureLevel> levels;
  std::vector<uint8_t> levels8;
  std::vector<float> levels_float;

  // patterns and noise
  TextureMapping mapping = TextureMapping::uv;
  Affine from_scene;
  TextureOperand first, second, amount;  // mix: amount; checks, dots: inside or even, outside
  int octaves = 8;
  float persistence = 0.5f;           // of each octave over the one before
  float scale = 1, variation = 0.2f;  // marble
};

struct TextureValue {
  Rgb rgb{1};
  float alpha = 1;
};

// Mean over a footprint. NaN and infinite coordinates read as (0,0).
TextureValue evaluate(const std::vector<Texture>& textures, uint32_t texture,
                      const TexturePlace& place);

// (u,v) from one texel to the next, of the finest image that a texture is made of; 1/1024 where it
// is made of none.
Vec2 texel_step(const std::vector<Texture>& textures, uint32_t texture);

// Makes the levels of an image: a third more memory. Of other textures nothing.
void build_levels(Texture& texture);  // texture_levels.cpp

// Asks for the memory that evaluate() will read, so that it is there when many others have been
// asked for meanwhile. Changes nothing else.
void prefetch(const std::vector<Texture>& textures, uint32_t texture, const Vec2& uv);

}  // namespace troffer
