#include "shadow_rays.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "base/random.h"
#include "base/warp.h"
#include "light/light_sample.h"

namespace troffer::bench {

namespace {

// Squared size over squared distance above which a source counts as near. Measured: only there the
// better points are worth their cost.
constexpr double near_size2 = 2;

}  // namespace

float ray_length(const FlatSource& s, const Vec3& origin) {
  double m = 0;
  for (size_t a = 0; a < 3; ++a)
    m = std::max({m, std::abs(s.plane.origin[a]), double(std::abs(origin[a]))});
  const double height = dot(s.plane.normal, Vec3d(origin) - s.plane.origin);
  return float(std::max(1 - 2.5e-6 * m / height, 0.0));
}

namespace {

double fan_area(const std::vector<Vec2>& o, size_t i) {
  const Vec2 e = o[i] - o[0], f = o[i + 1] - o[0];
  return std::abs(double(e.x) * double(f.y) - double(e.y) * double(f.x)) / 2;
}

}  // namespace

Vec2 onto_outline(const FlatSource& s, Vec2 uv) {
  if (s.is_disk) {
    const Vec2 p = disk_from_square(uv);
    return {0.5f + 0.5f * p.x, 0.5f + 0.5f * p.y};
  }
  const std::vector<Vec2>& o = s.outline;
  if (o.empty()) return uv;
  double all = 0, passed = 0;
  for (size_t i = 1; i + 1 < o.size(); ++i) all += fan_area(o, i);
  for (size_t i = 1;; ++i) {
    const double share = fan_area(o, i) / all;
    if (double(uv.x) < passed + share || i + 2 == o.size()) {
      const float along = std::clamp(float((double(uv.x) - passed) / share), 0.0f, 1.0f);
      return o[0] + ((o[i] - o[0]) * (1 - along) + (o[i + 1] - o[0]) * along) * std::sqrt(uv.y);
    }
    passed += share;
  }
}

double area_of(const FlatSource& s) {
  const double square = length(cross(s.plane.u, s.plane.v));
  if (s.is_disk) return square * pi / 4;
  if (s.outline.empty()) return square;
  double share = 0;
  for (size_t i = 1; i + 1 < s.outline.size(); ++i) share += fan_area(s.outline, i);
  return square * share;
}

namespace {

// Sorts points by rectangle. Among the first n points of a (0,m,2)-net, each of n / 16 equal
// rectangles holds 16.
void order_compactly(uint32_t n, ShadowRays& out) {
  const uint32_t cells = n / 16;
  const auto bits = uint32_t(std::countr_zero(cells));
  const uint32_t columns = 1u << ((bits + 1) / 2), rows = 1u << (bits / 2);
  out.starts.assign(cells + 1, 0);
  const auto cell_of = [&](uint32_t i) {
    const auto c = uint32_t(out.numbers[i] * float(columns));
    const auto r = uint32_t(out.numbers[n + i] * float(rows));
    return r * columns + c;
  };
  for (uint32_t i = 0; i < n; ++i) ++out.starts[cell_of(i) + 1];
  for (uint32_t c = 0; c < cells; ++c) out.starts[c + 1] += out.starts[c];
  for (uint32_t i = 0; i < n; ++i) out.order[out.starts[cell_of(i)]++] = i;
}

// Sets out.numbers to points [first, first + n), all u before all v, and out.order to their order.
void draw_points(uint64_t stream, uint32_t first, uint32_t n, RayOrder order, ShadowRays& out) {
  out.streams.assign(n, stream);
  out.samples.resize(n);
  std::iota(out.samples.begin(), out.samples.end(), first);
  out.numbers.resize(2 * size_t(n));
  sobol_groups(out.streams.data(), out.samples.data(), n, 0, 2, out.numbers.data());
  out.order.resize(n);
  if (order == RayOrder::compact && n >= 32 && std::has_single_bit(n))
    order_compactly(n, out);
  else
    std::iota(out.order.begin(), out.order.end(), 0u);
}

// Removes the rays from `before` on if none of them has weight.
bool keep_if_any(size_t before, ShadowRays& out) {
  float sum = 0;
  for (size_t i = before; i < out.weights.size(); ++i) sum += out.weights[i];
  if (sum > 0) return true;
  out.rays.resize(before);
  out.weights.resize(before);
  if (!out.points.empty()) out.points.resize(before);
  return false;
}

}  // namespace

bool add_shadow_rays(const FlatSource& s, const HitPoint& hit, uint64_t stream, uint32_t first,
                     uint32_t n, RayOrder order, bool keeps_points, ShadowRays& out) {
  const Vec3d x(hit.position);
  if (!(dot(s.plane.normal, x - s.plane.origin) > 0)) return false;
  draw_points(stream, first, n, order, out);
  const Vec3 o = Vec3(s.plane.origin - x), u(s.plane.u), v(s.plane.v);
  const Vec3 shift = hit.position - hit.origin;
  const float length = ray_length(s, hit.origin);
  const bool is_plain = !s.is_disk && s.outline.empty();
  const size_t before = out.rays.size();
  out.rays.resize(before + n);
  out.weights.resize(before + n);
  for (uint32_t i = 0; i < n; ++i) {
    const uint32_t k = out.order[i];
    Vec2 uv{out.numbers[k], out.numbers[n + k]};
    if (!is_plain) uv = onto_outline(s, uv);
    if (keeps_points) out.points.push_back(uv);
    const Vec3 d = o + u * uv.x + v * uv.y;
    const float cosine = dot(d, hit.normal), square = dot(d, d);
    const float w = cosine > 0 ? cosine / (square * square) : 0;
    out.weights[before + i] = w;
    Ray& r = out.rays[before + i];
    r.origin = hit.origin;
    r.t_min = 0;
    r.direction = d + shift;
    r.t_max = w > 0 ? length : 0.0f;
  }
  return keep_if_any(before, out);
}

bool is_near(const FlatSource& s, const Vec3& position) {
  const Vec3d centre = s.plane.origin + (s.plane.u + s.plane.v) * 0.5;
  const double size2 = length_squared(s.plane.u) + length_squared(s.plane.v);
  return size2 > near_size2 * length_squared(Vec3d(position) - centre);
}

bool add_shadow_rays_by_angle(const FlatSource& s, const LightPrimitive& piece, const HitPoint& hit,
                              uint64_t stream, uint32_t n, RayOrder order, ShadowRays& out) {
  if (!(dot(s.plane.normal, Vec3d(hit.position) - s.plane.origin) > 0)) return false;
  draw_points(stream, 0, n, order, out);
  const Vec3 shift = hit.position - hit.origin;
  const float length = ray_length(s, hit.origin);
  const size_t before = out.rays.size();
  for (uint32_t i = 0; i < n; ++i) {
    const uint32_t k = out.order[i];
    LightSample sample;
    Ray r{hit.origin, 0, {0, 0, 1}, 0};
    float w = 0;
    if (troffer::sample(piece, hit.position, {out.numbers[k], out.numbers[n + k]}, sample)) {
      w = std::max(dot(sample.wi, hit.normal), 0.0f) / sample.pdf_solid_angle;
      r.direction = sample.wi * sample.distance + shift;
      r.t_max = w > 0 ? length : 0.0f;
    }
    out.rays.push_back(r);
    out.weights.push_back(w);
  }
  return keep_if_any(before, out);
}

}  // namespace troffer::bench
