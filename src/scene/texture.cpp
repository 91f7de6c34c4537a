#include "scene/texture.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace troffer {

namespace {

const std::array<float, 256>& srgb_table() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> t{};
    for (size_t i = 0; i < 256; ++i) t[i] = linear_from_srgb(float(i) / 255.0f);
    return t;
  }();
  return table;
}

constexpr int outside = -1;

// The two texels along one axis between which a coordinate lies, and how far towards the second.
struct TexelPair {
  int first, second;
  float t;
};

// Without division of integers: this runs for every textured hit.
TexelPair texels_at(float coordinate, int n, WrapMode mode, bool is_filtered) {
  float c = coordinate;
  if (mode == WrapMode::repeat) {
    c -= std::floor(c);
  } else if (mode == WrapMode::mirror) {
    c -= 2 * std::floor(c * 0.5f);
    c = c > 1 ? 2 - c : c;
  } else {
    c = std::clamp(c, -2.0f, 3.0f);  // far outside is as outside as just outside
  }
  const float x = c * float(n) - (is_filtered ? 0.5f : 0.0f);
  const float low = std::floor(x);
  int i = int(low), j = i + 1;
  switch (mode) {
    case WrapMode::repeat:
      i = i < 0 ? n - 1 : i >= n ? 0 : i;
      j = j >= n ? j - n : j;
      j = j >= n ? 0 : j;
      break;
    case WrapMode::mirror:
    case WrapMode::clamp:
      i = std::clamp(i, 0, n - 1);
      j = std::clamp(j, 0, n - 1);
      break;
    case WrapMode::black:
      i = i < 0 || i >= n ? outside : i;
      j = j < 0 || j >= n ? outside : j;
      break;
  }
  if (!is_filtered) return {i, i, 0};
  return {i, j, x - low};
}

TextureValue texel(const Texture& t, int i, int j) {
  if (i < 0 || j < 0) return {Rgb{0}, 0};
  const size_t n = size_t(t.channels);
  const size_t at = (size_t(j) * size_t(t.width) + size_t(i)) * n;
  if (!t.texels8.empty() && t.is_srgb && n == 3) {  // most of what there is
    const std::array<float, 256>& table = srgb_table();
    const uint8_t* c = t.texels8.data() + at;
    return {{table[c[0]], table[c[1]], table[c[2]]}, 1};
  }
  std::array<float, 4> c{0, 0, 0, 1};
  const size_t alpha_channel = n == 2 ? 1 : n == 4 ? 3 : n;  // n: none
  for (size_t k = 0; k < n; ++k) {
    if (t.texels8.empty())
      c[k] = t.texels_float[at + k];
    else if (t.is_srgb && k != alpha_channel)
      c[k] = srgb_table()[t.texels8[at + k]];
    else
      c[k] = float(t.texels8[at + k]) / 255.0f;
  }
  if (n == 1) return {Rgb{c[0]}, 1};
  if (n == 2) return {Rgb{c[0]}, c[1]};
  return {Rgb{c[0], c[1], c[2]}, c[3]};
}

TextureValue blend(const TextureValue& a, const TextureValue& b, float t) {
  return {a.rgb * (1 - t) + b.rgb * t, a.alpha * (1 - t) + b.alpha * t};
}

// Texels that a lookup reads, and how it blends them.
struct Footprint {
  TexelPair x, y;
};

Footprint footprint_at(const Texture& t, const Vec2& uv_in) {
  // KHR_texture_transform: offset + rotation * (scale * uv), counterclockwise with v down.
  Vec2 uv{uv_in.x * t.uv_scale.x, uv_in.y * t.uv_scale.y};
  if (t.uv_rotation_rad != 0) {
    const float c = std::cos(t.uv_rotation_rad), s = std::sin(t.uv_rotation_rad);
    uv = {c * uv.x + s * uv.y, -s * uv.x + c * uv.y};
  }
  uv = uv + t.uv_offset;
  if (!(std::abs(uv.x) < 1e9f && std::abs(uv.y) < 1e9f)) uv = {0, 0};
  return {texels_at(uv.x, t.width, t.wrap_u, t.is_filtered),
          texels_at(uv.y, t.height, t.wrap_v, t.is_filtered)};
}

TextureValue image_value(const Texture& t, const Vec2& uv) {
  const auto [x, y] = footprint_at(t, uv);
  TextureValue v = texel(t, x.first, y.first);
  if (t.is_filtered)
    v = blend(blend(v, texel(t, x.second, y.first), x.t),
              blend(texel(t, x.first, y.second), texel(t, x.second, y.second), x.t), y.t);
  if (t.is_inverted) v.rgb = clamp01(Rgb{1} - v.rgb);
  v.rgb *= t.value;
  return v;
}

}  // namespace

TextureValue evaluate(const std::vector<Texture>& textures, uint32_t texture, const Vec2& uv) {
  const Texture& t = textures[texture];
  switch (t.kind) {
    case TextureKind::constant:
      return {t.value, 1};
    case TextureKind::image:
      return image_value(t, uv);
    case TextureKind::product: {
      // Factors have lower indices, so this ends.
      const TextureValue a = evaluate(textures, t.factor_a, uv);
      const TextureValue b = evaluate(textures, t.factor_b, uv);
      return {a.rgb * b.rgb * t.value, a.alpha * b.alpha};
    }
  }
  return {};
}

void prefetch(const std::vector<Texture>& textures, uint32_t texture, const Vec2& uv) {
#if defined(__GNUC__)
  const Texture& t = textures[texture];
  if (t.kind == TextureKind::product) {
    prefetch(textures, t.factor_a, uv);
    prefetch(textures, t.factor_b, uv);
  }
  if (t.kind != TextureKind::image) return;
  const auto [x, y] = footprint_at(t, uv);
  if (x.first < 0) return;
  for (const int j : {y.first, y.second}) {
    if (j < 0) continue;
    const size_t at = (size_t(j) * size_t(t.width) + size_t(x.first)) * size_t(t.channels);
    if (t.texels8.empty())
      __builtin_prefetch(t.texels_float.data() + at);
    else
      __builtin_prefetch(t.texels8.data() + at);
  }
#else
  (void)textures, (void)texture, (void)uv;
#endif
}

}  // namespace troffer
