#include "scene/texture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/prefetch.h"
#include "scene/texture_patterns.h"

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

// The two texels around a coordinate along one axis, and the weight of the second.
struct TexelPair {
  int first, second;
  float t;
};

// Avoids integer division: this runs for every textured hit.
TexelPair texels_at(float coordinate, int n, WrapMode mode, bool is_filtered) {
  float c = coordinate;
  if (mode == WrapMode::repeat) {
    c -= std::floor(c);
  } else if (mode == WrapMode::mirror) {
    c -= 2 * std::floor(c * 0.5f);
    c = c > 1 ? 2 - c : c;
  } else {
    c = std::clamp(c, -2.0f, 3.0f);  // beyond one tile outside, the distance does not matter
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

// One resolution of an image.
struct Texels {
  const uint8_t* bytes;  // null: floats
  const float* floats;
  int width, height;
};

Texels whole_image(const Texture& t) {
  return {t.texels8.empty() ? nullptr : t.texels8.data(), t.texels_float.data(), t.width, t.height};
}

Texels texels_of(const Texture& t, const TextureLevel& l) {
  return {l.is_float ? nullptr : t.levels8.data() + l.first,
          l.is_float ? t.levels_float.data() + l.first : nullptr, l.width, l.height};
}

TextureValue texel(const Texture& t, const Texels& from, int i, int j) {
  if (i < 0 || j < 0) return {Rgb{0}, 0};
  const size_t n = size_t(t.channels);
  const size_t at = (size_t(j) * size_t(from.width) + size_t(i)) * n;
  if (from.bytes != nullptr && t.is_srgb && n == 3) {  // the most common case
    const std::array<float, 256>& table = srgb_table();
    const uint8_t* c = from.bytes + at;
    return {{table[c[0]], table[c[1]], table[c[2]]}, 1};
  }
  std::array<float, 4> c{0, 0, 0, 1};
  const size_t alpha_channel = n == 2 ? 1 : n == 4 ? 3 : n;  // n if there is none
  for (size_t k = 0; k < n; ++k) {
    if (from.bytes == nullptr)
      c[k] = from.floats[at + k];
    else if (t.is_srgb && k != alpha_channel)
      c[k] = srgb_table()[from.bytes[at + k]];
    else
      c[k] = float(from.bytes[at + k]) / 255.0f;
  }
  if (n == 1) return {Rgb{c[0]}, 1};
  if (n == 2) return {Rgb{c[0]}, c[1]};
  return {Rgb{c[0], c[1], c[2]}, c[3]};
}

TextureValue blend(const TextureValue& a, const TextureValue& b, float t) {
  return {a.rgb * (1 - t) + b.rgb * t, a.alpha * (1 - t) + b.alpha * t};
}

// Texels that a lookup reads, and their weights.
struct Footprint {
  TexelPair x, y;
};

// Offset on the surface, in the image's (u,v), by KHR_texture_transform: rotation * (scale * uv),
// counterclockwise with v down.
Vec2 turned(const Texture& t, const Vec2& way) {
  const Vec2 uv{way.x * t.uv_scale.x, way.y * t.uv_scale.y};
  if (t.uv_rotation_rad == 0) return uv;
  const float c = std::cos(t.uv_rotation_rad), s = std::sin(t.uv_rotation_rad);
  return {c * uv.x + s * uv.y, -s * uv.x + c * uv.y};
}

Vec2 image_place(const Texture& t, const Vec2& at) {
  const Vec2 uv = turned(t, at) + t.uv_offset;
  return std::abs(uv.x) < 1e9f && std::abs(uv.y) < 1e9f ? uv : Vec2{0, 0};
}

Footprint footprint_at(const Texture& t, const Texels& of, const Vec2& uv, bool is_filtered) {
  return {texels_at(uv.x, of.width, t.wrap_u, is_filtered),
          texels_at(uv.y, of.height, t.wrap_v, is_filtered)};
}

TextureValue texels_value(const Texture& t, const Texels& of, const Vec2& uv, bool is_filtered) {
  const auto [x, y] = footprint_at(t, of, uv, is_filtered);
  const TextureValue v = texel(t, of, x.first, y.first);
  if (!is_filtered) return v;
  return blend(blend(v, texel(t, of, x.second, y.first), x.t),
               blend(texel(t, of, x.first, y.second), texel(t, of, x.second, y.second), x.t), y.t);
}

// Lookup of a footprint: `count` probes along `side`, in (u,v), at a fractional level.
struct Probes {
  int count = 1;
  Vec2 side;
  float level = 0;
};

// Chooses a level whose texels are as wide as the footprint's shorter side. A footprint more than
// eight times as long as wide is widened.
Probes probes_of(const Texture& t, const TexturePlace& place) {
  constexpr int most = 8;
  Vec2 a = turned(t, place.axis_a), b = turned(t, place.axis_b);
  const auto texels = [&](const Vec2& v) {
    return Vec2{v.x * float(t.width), v.y * float(t.height)};
  };
  Vec2 at = texels(a), bt = texels(b);
  if (dot(bt, bt) > dot(at, at)) {
    std::swap(a, b);
    std::swap(at, bt);
  }
  const float long2 = dot(at, at);
  Probes p;
  if (!(long2 > 1) || !std::isfinite(long2)) return p;
  const float longer = std::sqrt(long2);
  const float shorter = std::max(std::abs(at.x * bt.y - at.y * bt.x) / longer, 1.0f);
  p.count = std::min(int(std::ceil(longer / shorter)), most);
  p.side = a;
  p.level = std::log2(std::max(shorter, longer / float(p.count)));
  return p;
}

TextureValue level_value(const Texture& t, size_t level, const Vec2& uv) {
  if (level == 0) return texels_value(t, whole_image(t), uv, t.is_filtered);
  return texels_value(t, texels_of(t, t.levels[level - 1]), uv, true);
}

TextureValue mean_over(const Texture& t, const Probes& p, const Vec2& uv) {
  const float top = std::min(p.level, float(t.levels.size()));
  const auto low = size_t(top);
  const float between = top - float(low);
  TextureValue sum{Rgb{0}, 0};
  for (int i = 0; i < p.count; ++i) {
    const Vec2 at = uv + p.side * ((float(i) + 0.5f) / float(p.count) - 0.5f);
    TextureValue v = level_value(t, low, at);
    if (between > 0) v = blend(v, level_value(t, low + 1, at), between);
    sum.rgb += v.rgb;
    sum.alpha += v.alpha;
  }
  return {sum.rgb * (1 / float(p.count)), sum.alpha / float(p.count)};
}

TextureValue image_value(const Texture& t, const TexturePlace& given) {
  const TexturePlace place = t.mapping == TextureMapping::uv ? given : mapped_place(t, given);
  const Vec2 uv = image_place(t, place.uv);
  const Probes p = t.levels.empty() ? Probes{} : probes_of(t, place);
  TextureValue v = p.count == 1 && p.level <= 0 ? texels_value(t, whole_image(t), uv, t.is_filtered)
                                                : mean_over(t, p, uv);
  if (t.is_inverted) v.rgb = clamp01(Rgb{1} - v.rgb);
  v.rgb *= t.value;
  return v;
}

}  // namespace

TextureValue evaluate(const std::vector<Texture>& textures, uint32_t texture,
                      const TexturePlace& place) {
  const Texture& t = textures[texture];
  switch (t.kind) {
    case TextureKind::constant:
      return {t.value, 1};
    case TextureKind::image:
      return image_value(t, place);
    case TextureKind::product: {
      // Factors have lower indices, so the recursion ends.
      const TextureValue a = evaluate(textures, t.factor_a, place);
      const TextureValue b = evaluate(textures, t.factor_b, place);
      return {a.rgb * b.rgb * t.value, a.alpha * b.alpha};
    }
    case TextureKind::checks:
    case TextureKind::dots:
    case TextureKind::mix:
    case TextureKind::fbm:
    case TextureKind::wrinkled:
    case TextureKind::windy:
    case TextureKind::marble:
      return pattern_value(textures, t, place);
  }
  return {};
}

Vec2 texel_step(const std::vector<Texture>& textures, uint32_t texture) {
  constexpr float step = 1.0f / 1024;
  const Texture& t = textures[texture];
  if (t.kind == TextureKind::product) {
    const Vec2 a = texel_step(textures, t.factor_a), b = texel_step(textures, t.factor_b);
    return {std::min(a.x, b.x), std::min(a.y, b.y)};
  }
  if (t.kind != TextureKind::image || t.mapping > TextureMapping::second_uv) return {step, step};
  const auto one = [](float scale, int n) {
    return 1 / std::max(std::abs(scale) * float(n), 1e-6f);
  };
  return {one(t.uv_scale.x, t.width), one(t.uv_scale.y, t.height)};
}

void prefetch(const std::vector<Texture>& textures, uint32_t texture, const Vec2& uv) {
  const Texture& t = textures[texture];
  if (t.kind == TextureKind::product) {
    prefetch(textures, t.factor_a, uv);
    prefetch(textures, t.factor_b, uv);
  }
  if (t.kind != TextureKind::image) return;
  const auto [x, y] = footprint_at(t, whole_image(t), image_place(t, uv), t.is_filtered);
  if (x.first < 0) return;
  for (const int j : {y.first, y.second}) {
    if (j < 0) continue;
    const size_t at = (size_t(j) * size_t(t.width) + size_t(x.first)) * size_t(t.channels);
    if (t.texels8.empty())
      prefetch_line(t.texels_float.data() + at);
    else
      prefetch_line(t.texels8.data() + at);
  }
}

}  // namespace troffer
