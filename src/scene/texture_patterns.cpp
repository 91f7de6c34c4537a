#include "scene/texture_patterns.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "base/units.h"

namespace troffer {

namespace {

constexpr float farthest = 1e8f;  // larger coordinates count as 0
constexpr float finest = 1e15f;   // the same for octaves

Vec3 in_texture(const Texture& t, const Vec3& position) {
  const Vec3 p(t.from_scene.point(Vec3d(position)));
  const Vec3 reach = abs(p);
  return reach.x < farthest && reach.y < farthest && reach.z < farthest ? p : Vec3{};
}

// Largest factor by which the transform to texture space stretches lengths.
float stretch(const Texture& t) {
  double most = 0;
  for (const Vec3d& c : t.from_scene.columns) most = std::max(most, length(c));
  return float(most);
}

// ---- noise

uint64_t cell_hash(int64_t x, int64_t y, int64_t z) {
  return hash_of(uint64_t(x), uint64_t(y), uint64_t(z));
}

// Dot product of a corner's gradient, one of the twelve edge directions of a cube [2], and the
// offset from it.
float slope(int64_t x, int64_t y, int64_t z, const Vec3& way) {
  const uint64_t h = cell_hash(x, y, z) >> 33;
  const uint64_t axis = h % 3;
  const float a = axis == 0 ? way.y : way.x, b = axis == 2 ? way.y : way.z;
  return ((h >> 8 & 1) != 0 ? a : -a) + ((h >> 9 & 1) != 0 ? b : -b);
}

float ease(float t) {
  return t * t * t * (t * (t * 6 - 15) + 10);
}

// Gradient noise with mean 0, within about ±1.
float noise(const Vec3& p) {
  const auto cell = [](float v) { return int64_t(std::floor(v)); };
  const Vec3 reach = abs(p);
  if (!(reach.x < finest && reach.y < finest && reach.z < finest)) return 0;
  const int64_t x = cell(p.x), y = cell(p.y), z = cell(p.z);
  const Vec3 f{p.x - float(x), p.y - float(y), p.z - float(z)};
  const auto mix = [](float a, float b, float t) { return a + (b - a) * t; };
  const float u = ease(f.x), v = ease(f.y), w = ease(f.z);
  float planes[2];
  for (int k = 0; k < 2; ++k) {
    float rows[2];
    for (int j = 0; j < 2; ++j) {
      const Vec3 way{f.x, f.y - float(j), f.z - float(k)};
      rows[j] = mix(slope(x, y + j, z + k, way),
                    slope(x + 1, y + j, z + k, {way.x - 1, way.y, way.z}), u);
    }
    planes[k] = mix(rows[0], rows[1], v);
  }
  return mix(planes[0], planes[1], w);
}

// Sum of octaves, each twice as fine and `persistence` as strong as the one before. Octaves finer
// than half the footprint are left out, the last one in part. is_absolute sums absolute values
// (turbulence).
float octaves_of_noise(Vec3 p, float width, float persistence, int octaves, bool is_absolute) {
  const float visible = width > 0 ? -1 - std::log2(width) : float(octaves);
  const float count = std::clamp(visible, 0.0f, float(octaves));
  const auto term = [&](const Vec3& at) { return is_absolute ? std::abs(noise(at)) : noise(at); };
  float sum = 0, strength = 1;
  int i = 0;
  for (; i < int(count); ++i) {
    sum += strength * term(p);
    strength *= persistence;
    p = p * 1.99f + Vec3{0.37f};  // not 2: zeros of octaves must not coincide
  }
  if (i < octaves) sum += strength * ease(count - float(i)) * (term(p) - (is_absolute ? 0.25f : 0));
  if (!is_absolute) return sum;
  for (; i < octaves; ++i) {  // mean of the omitted octaves
    sum += 0.25f * strength;
    strength *= persistence;
  }
  return sum;
}

float windy(const Vec3& p, float width) {
  const float wind = octaves_of_noise(p * 0.1f, 0.1f * width, 0.5f, 3, false);
  return std::abs(wind) * octaves_of_noise(p, width, 0.5f, 6, false);
}

// Layers along y, bent by noise: a light stone with dark veins.
Rgb marble(const Texture& t, const Vec3& p, float width) {
  const float bent = p.y + t.variation * octaves_of_noise(p * t.scale, width * t.scale,
                                                          t.persistence, t.octaves, false);
  const float phase = 0.5f + 0.5f * std::sin(bent);
  const Rgb stone{0.87f, 0.87f, 0.9f}, grey{0.76f, 0.76f, 0.76f}, vein{0.3f, 0.3f, 0.5f};
  const auto near = [&](float middle) {
    return std::max(0.0f, 1 - std::abs(phase - middle) / 0.125f);
  };
  const float g = near(0.375f), v = near(0.875f);
  return stone * (1 - g - v) + grey * g + vein * v;
}

// ---- patterns

// Mean over [x - d/2, x + d/2] of a function that is 1 in even cells and -1 in odd ones.
float mean_of_squares(float x, float d) {
  const auto even = [](float v) { return v - 2 * std::floor(v * 0.5f); };  // in [0, 2)
  if (d < 1e-4f) return even(x) < 1 ? 1.0f : -1.0f;
  if (!(d < 1e4f)) return 0;
  const double from = double(x) - 0.5 * double(d), to = double(x) + 0.5 * double(d);
  const auto integral = [](double v) { return 1 - std::abs(1 - (v - 2 * std::floor(v * 0.5))); };
  return float((integral(to) - integral(from)) / double(d));
}

float extent(const TexturePlace& p, bool is_u) {
  return is_u ? std::abs(p.axis_a.x) + std::abs(p.axis_b.x)
              : std::abs(p.axis_a.y) + std::abs(p.axis_b.y);
}

// Place in the pattern's own (s,t).
TexturePlace pattern_place(const Texture& t, const TexturePlace& given) {
  TexturePlace p = t.mapping == TextureMapping::uv ? given : mapped_place(t, given);
  const auto turn = [&](const Vec2& v) { return Vec2{v.x * t.uv_scale.x, v.y * t.uv_scale.y}; };
  p.uv = turn(p.uv) + t.uv_offset;
  if (!(std::abs(p.uv.x) < farthest && std::abs(p.uv.y) < farthest)) p.uv = {0, 0};
  p.axis_a = turn(p.axis_a);
  p.axis_b = turn(p.axis_b);
  return p;
}

// Share of `first` in a checkerboard.
float even_share(const Texture& t, const TexturePlace& given) {
  if (t.mapping == TextureMapping::solid) {
    const Vec3 p = in_texture(t, given.position);
    const float d = given.width * stretch(t);
    return 0.5f +
           0.5f * mean_of_squares(p.x, d) * mean_of_squares(p.y, d) * mean_of_squares(p.z, d);
  }
  const TexturePlace p = pattern_place(t, given);
  return 0.5f + 0.5f * mean_of_squares(p.uv.x, extent(p, true)) *
                    mean_of_squares(p.uv.y, extent(p, false));
}

// Disk at a random place in half of the cells, chosen by hash. A footprint as large as a cell gets
// the disks' share of the area.
float inside_dots(const Texture& t, const TexturePlace& given) {
  constexpr float radius = 0.35f, most_shift = 0.5f - radius;
  const TexturePlace p = pattern_place(t, given);
  const float d = 0.5f * (extent(p, true) + extent(p, false));
  if (d >= 1) return 0.5f * pi_f * radius * radius;
  const int s = int(std::floor(p.uv.x + 0.5f)), v = int(std::floor(p.uv.y + 0.5f));
  const uint64_t h = cell_hash(s, v, 0);
  if ((h & 1) != 0) return 0;
  const auto shift = [&](int bits) {
    return most_shift * (2 * unit_float(uint32_t(h >> bits)) - 1);
  };
  const Vec2 from{p.uv.x - float(s) - shift(8), p.uv.y - float(v) - shift(32)};
  const float inside = radius - std::sqrt(dot(from, from));
  return std::clamp(0.5f + inside / std::max(d, 1e-6f), 0.0f, 1.0f);
}

Rgb operand(const std::vector<Texture>& textures, const TextureOperand& o,
            const TexturePlace& place) {
  return o.texture < 0 ? o.value : o.value * evaluate(textures, uint32_t(o.texture), place).rgb;
}

// Share of `second`.
float mixed_share(const std::vector<Texture>& textures, const Texture& t,
                  const TexturePlace& place) {
  if (t.kind == TextureKind::checks) return 1 - even_share(t, place);
  if (t.kind == TextureKind::dots) return 1 - inside_dots(t, place);
  return std::clamp(operand(textures, t.amount, place).r, 0.0f, 1.0f);
}

}  // namespace

TexturePlace mapped_place(const Texture& t, const TexturePlace& place) {
  TexturePlace out = place;
  if (t.mapping == TextureMapping::second_uv) {
    out.uv = place.uv_2;
    out.axis_a = place.axis_2a;
    out.axis_b = place.axis_2b;
    return out;
  }
  const Vec3 p = in_texture(t, place.position);
  const float d = place.width * stretch(t);
  const auto set = [&](const Vec2& uv, float wide, float high) {
    out.uv = uv;
    out.axis_a = {std::min(wide, 1.0f), 0};
    out.axis_b = {0, std::min(high, 1.0f)};
  };
  constexpr float around = 0.5f * inv_pi_f;
  const float from_axis = std::sqrt(p.x * p.x + p.y * p.y), r = length(p);
  const float turn = std::atan2(p.y, p.x) * around;
  switch (t.mapping) {
    case TextureMapping::spherical:
      set({std::atan2(from_axis, p.z) * inv_pi_f, turn < 0 ? turn + 1 : turn},
          d * inv_pi_f / std::max(r, 1e-6f), d * around / std::max(from_axis, 1e-6f));
      break;
    case TextureMapping::cylindrical:
      set({0.5f + turn, p.z}, d * around / std::max(from_axis, 1e-6f), d);
      out.axis_b = {0, d};
      break;
    case TextureMapping::planar:
      out.uv = {p.x, p.y};
      out.axis_a = {d, 0};
      out.axis_b = {0, d};
      break;
    case TextureMapping::uv:
    case TextureMapping::second_uv:
    case TextureMapping::solid:
      break;
  }
  return out;
}

TextureValue pattern_value(const std::vector<Texture>& textures, const Texture& t,
                           const TexturePlace& place) {
  const auto solid = [&] { return in_texture(t, place.position); };
  const float width = place.width * stretch(t);
  switch (t.kind) {
    case TextureKind::checks:
    case TextureKind::dots:
    case TextureKind::mix: {
      const float share = mixed_share(textures, t, place);
      Rgb sum;
      if (share < 1) sum += operand(textures, t.first, place) * (1 - share);
      if (share > 0) sum += operand(textures, t.second, place) * share;
      return {sum, 1};
    }
    case TextureKind::fbm:
      return {Rgb{octaves_of_noise(solid(), width, t.persistence, t.octaves, false)}, 1};
    case TextureKind::wrinkled:
      return {Rgb{octaves_of_noise(solid(), width, t.persistence, t.octaves, true)}, 1};
    case TextureKind::windy:
      return {Rgb{windy(solid(), width)}, 1};
    case TextureKind::marble:
      return {marble(t, solid(), width), 1};
    default:
      return {};
  }
}

}  // namespace troffer
