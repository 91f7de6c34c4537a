#include "scene/texture.h"

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

// Texel index along one axis after wrapping; -1 = outside (black).
int wrapped(long long i, int n, WrapMode mode) {
  switch (mode) {
    case WrapMode::repeat:
      return int(((i % n) + n) % n);
    case WrapMode::mirror: {
      const long long m = ((i % (2LL * n)) + 2LL * n) % (2LL * n);
      return int(m < n ? m : 2LL * n - 1 - m);
    }
    case WrapMode::clamp:
      return int(std::min<long long>(std::max<long long>(i, 0), n - 1));
    case WrapMode::black:
      return i < 0 || i >= n ? -1 : int(i);
  }
  return 0;
}

TextureValue texel(const Texture& t, long long x, long long y) {
  const int i = wrapped(x, t.width, t.wrap_u), j = wrapped(y, t.height, t.wrap_v);
  if (i < 0 || j < 0) return {Rgb{0}, 0};
  const size_t at = (size_t(j) * size_t(t.width) + size_t(i)) * size_t(t.channels);
  std::array<float, 4> c{0, 0, 0, 1};
  const size_t n = size_t(t.channels);
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

TextureValue image_value(const Texture& t, const Vec2& uv_in) {
  // KHR_texture_transform: offset + rotation * (scale * uv), counterclockwise with v down.
  Vec2 uv{uv_in.x * t.uv_scale.x, uv_in.y * t.uv_scale.y};
  if (t.uv_rotation_rad != 0) {
    const float c = std::cos(t.uv_rotation_rad), s = std::sin(t.uv_rotation_rad);
    uv = {c * uv.x + s * uv.y, -s * uv.x + c * uv.y};
  }
  uv = uv + t.uv_offset;
  if (!(std::abs(uv.x) < 1e9f && std::abs(uv.y) < 1e9f)) uv = {0, 0};
  const float x = uv.x * float(t.width), y = uv.y * float(t.height);
  TextureValue v;
  if (!t.is_filtered) {
    v = texel(t, static_cast<long long>(std::floor(x)), static_cast<long long>(std::floor(y)));
  } else {
    const float xs = x - 0.5f, ys = y - 0.5f;
    const float x0 = std::floor(xs), y0 = std::floor(ys);
    const float fx = xs - x0, fy = ys - y0;
    const auto i = static_cast<long long>(x0), j = static_cast<long long>(y0);
    const TextureValue a = texel(t, i, j), b = texel(t, i + 1, j);
    const TextureValue c = texel(t, i, j + 1), d = texel(t, i + 1, j + 1);
    v.rgb = (a.rgb * (1 - fx) + b.rgb * fx) * (1 - fy) + (c.rgb * (1 - fx) + d.rgb * fx) * fy;
    v.alpha =
        (a.alpha * (1 - fx) + b.alpha * fx) * (1 - fy) + (c.alpha * (1 - fx) + d.alpha * fx) * fy;
  }
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

}  // namespace troffer
