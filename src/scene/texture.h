// Textures: images, products of textures, patterns and noise. Used by materials and lights at hits.
//
// A lookup has a footprint, the part of the surface that one ray represents. Images return their
// mean over it, from levels of halved size, by several probes along its longer side. A footprint of
// size zero returns the bilinear value of the full image.
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
  // pbrt's patterns [3] of `first` and `second`
  checks,
  dots,
  mix,
  // pbrt's noise [3]
  fbm,
  wrinkled,
  windy,
  marble,
};
// Coordinates of a lookup: the surface's (u,v), its second (u,v), or the position transformed by
// Texture::from_scene. The position gives (u,v) on a sphere or cylinder around z, or by x and y.
// solid: patterns and noise use all three coordinates.
enum class TextureMapping : uint8_t { uv, second_uv, spherical, cylindrical, planar, solid };

// Place of a lookup and the footprint around it.
struct TexturePlace {
  Vec2 uv;
  Vec2 axis_a, axis_b;  // sides of the footprint in (u,v); 0 for a point
  // The same in the second texture coordinates.
  Vec2 uv_2, axis_2a, axis_2b;
  Vec3 position;    // relative to the scene's origin, m
  float width = 0;  // shorter side of the footprint, m
  // Direction in which anisotropic gloss is widest: unit, in Frame(shading normal).
  Vec2 grain{1, 0};
  // x and y of the coat's normal in that frame, if it differs from the base's.
  Vec2 coat_normal{0, 0};

  TexturePlace() = default;
  // A point without further data.
  TexturePlace(const Vec2& at) : uv(at), uv_2(at) {}
  TexturePlace(const Vec2& at, const Vec2& at_2) : uv(at), uv_2(at_2) {}
  operator const Vec2&() const { return uv; }
};

// Constant factor times an optional texture.
struct TextureOperand {
  Rgb value{1};
  int32_t texture = -1;  // index, lower than this texture's; -1: none
};

// An image at reduced size.
struct TextureLevel {
  int width = 0, height = 0;
  size_t first = 0;       // start of the level in levels_float or levels8
  bool is_float = false;  // stored in levels_float
};

// (0,0) of (u,v) is the image's top left corner, with v down (glTF's rule). Importers of formats
// whose v points up set uv_scale.y = -1 and uv_offset.y = 1.
struct Texture {
  std::string name;
  TextureKind kind = TextureKind::constant;
  Rgb value{1};                         // constant: the value; image: factor on every texel
  uint32_t factor_a = 0, factor_b = 0;  // product: indices of two textures before this one

  // image
  int width = 0, height = 0;
  int channels = 0;                 // 1 grey, 2 grey+alpha, 3 rgb, 4 rgb+alpha
  std::vector<uint8_t> texels8;     // row-major, top row first; or texels_float
  std::vector<float> texels_float;  // linear; or texels8
  bool is_srgb = true;              // texels8 are sRGB-encoded, except alpha
  bool is_inverted = false;         // pbrt: 1 - value
  bool is_filtered = true;          // bilinear; otherwise nearest
  WrapMode wrap_u = WrapMode::repeat, wrap_v = WrapMode::repeat;
  Vec2 uv_scale{1, 1}, uv_offset{0, 0};  // lookup at uv * scale + offset
  float uv_rotation_rad = 0;             // KHR_texture_transform: rotation before the scale

  // Halves, quarters and so on down to one texel, from build_levels(). They keep the image's
  // encoding, except the smallest, which are floats because rounding to bytes would shift their
  // mean.
  std::vector<TextureLevel> levels;
  std::vector<uint8_t> levels8;
  std::vector<float> levels_float;

  // patterns and noise
  TextureMapping mapping = TextureMapping::uv;
  Affine from_scene;
  // mix: both, and amount; checks: even, odd; dots: inside, outside
  TextureOperand first, second, amount;
  int octaves = 8;
  float persistence = 0.5f;           // strength of each octave relative to the previous one
  float scale = 1, variation = 0.2f;  // marble
};

struct TextureValue {
  Rgb rgb{1};
  float alpha = 1;
};

// Returns the mean over the footprint. NaN and infinite coordinates count as (0,0).
TextureValue evaluate(const std::vector<Texture>& textures, uint32_t texture,
                      const TexturePlace& place);

// Distance between texels in (u,v), of the finest image in the texture; 1/1024 if there is none.
Vec2 texel_step(const std::vector<Texture>& textures, uint32_t texture);

// Makes the levels of an image, which takes a third more memory. No effect on other textures.
void build_levels(Texture& texture);  // texture_levels.cpp

// Prefetches the memory that evaluate() will read. Call it for many lookups before evaluating them.
void prefetch(const std::vector<Texture>& textures, uint32_t texture, const Vec2& uv);

}  // namespace troffer
