#include "integrate/far_points.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "integrate/far_counts.h"
#include "shadow/far_pilot.h"

namespace troffer {

namespace {

constexpr uint64_t purpose_points = 0x6661'7270, purpose_pilot = 0x6661'7271;
// A part gives so much of all light at most, or lies within a sine of its middle; and a cell is
// halved so often at most.
constexpr double most_share = 1.0 / 48, most_sine = 0.3;
constexpr int most_halvings = 8;
constexpr size_t most_waiting = 16384, pilots = 64;

Vec3d middle_of(const Parallelogram& p) {
  return p.origin + (p.u + p.v) * 0.5;
}

// As for other lights (far_draws.cpp).
constexpr double clutter = 2;

}  // namespace

Rgb far_radiance_of(const CertifiedSource& source, const Vec3& way) {
  if (!source.is_textured) return source.radiance;
  Rgb l;
  far_radiance(*source.far, 1, &way.x, &way.y, &way.z, &l.r, &l.g, &l.b);
  return l;
}

FarPoints::FarPoints(std::span<const CertifiedSource> sources) {
  double all = 0;
  for (const CertifiedSource& s : sources)
    all += double(luminance(s.radiance)) * length(cross(s.flat.plane.u, s.flat.plane.v)) /
           sqr(s.far->height);
  for (const CertifiedSource& s : sources) add(s, s.flat.plane, all, most_halvings);
}

void FarPoints::add(const CertifiedSource& source, const Parallelogram& plane, double all,
                    int halvings) {
  const double area = length(cross(plane.u, plane.v)), height = source.far->height;
  // from the scene's middle
  const Parallelogram& whole = source.flat.plane;
  const Vec3d u = whole.u, v = whole.v;
  const Vec3d at = middle_of(plane) - whole.origin;
  const double s = dot(at, u) / length_squared(u), t = dot(at, v) / length_squared(v);
  const Vec3d way = u * (s + double(source.far->from_u)) + v * (t + double(source.far->from_v)) -
                    whole.normal * height;
  const double distance = length(way);
  const double steradians = area * height / (distance * sqr(distance));
  const double sine = 0.5 * length(plane.u + plane.v) / distance;
  const Rgb l = far_radiance_of(source, Vec3(way));
  const double strength =
      steradians * (0.9 * double(luminance(l)) + 0.1 * double(luminance(source.radiance)));
  if (!source.flat.is_disk && halvings > 0 && (strength > most_share * all || sine > most_sine)) {
    const bool is_u = length_squared(plane.u) >= length_squared(plane.v);
    Parallelogram half = plane;
    (is_u ? half.u : half.v) *= 0.5;
    add(source, half, all, halvings - 1);
    half.origin += is_u ? half.u : half.v;
    add(source, half, all, halvings - 1);
    return;
  }
  parts_.push_back({plane, source.flat.is_disk ? area * 0.25 * pi : area, &source});
  const Vec3d d = way * (1 / distance);
  x_.push_back(float(d.x));
  y_.push_back(float(d.y));
  z_.push_back(float(d.z));
  sine_.push_back(float(sine));
  strength_.push_back(float(strength * (source.flat.is_disk ? 0.25 * pi : 1)));
}

bool FarPoints::set_chances(const ShadowReceiver& r, std::vector<float>& sums) const {
  const size_t n = parts_.size();
  sums.resize(n);
  const Vec3 normal = r.normal;
  for (size_t i = 0; i < n; ++i) {
    const float cosine = normal.x * x_[i] + normal.y * y_[i] + normal.z * z_[i];
    // 1.01: no part of which some is above the horizon is left out
    const float reach = 1.01f * sine_[i] + 1e-3f;
    sums[i] = cosine + reach > 0 ? strength_[i] * std::max(cosine, 0.3f * reach) : 0.0f;
  }
  for (size_t i = 1; i < n; ++i) sums[i] += sums[i - 1];
  return sums.back() > 0;
}

FarPoints::Point FarPoints::point(const ShadowReceiver& r, const std::vector<float>& sums, float u,
                                  float v, float place) const {
  const float target = place * sums.back();
  const size_t k = std::min(
      size_t(std::upper_bound(sums.begin(), sums.end(), target) - sums.begin()), sums.size() - 1);
  const float own = k == 0 ? sums[0] : sums[k] - sums[k - 1];
  if (!(own > 0)) return {};
  const Part& part = parts_[k];
  const Parallelogram& p = part.plane;
  double a = double(u), b = double(v);
  if (part.source->flat.is_disk) {
    const double radius = 0.5 * std::sqrt(a), angle = 2 * pi * b;
    a = 0.5 + radius * std::cos(angle);
    b = 0.5 + radius * std::sin(angle);
  }
  const Vec3d x(r.position), way = p.origin + p.u * a + p.v * b - x;
  const double distance = length(way), height = dot(p.normal, x - p.origin);
  Point out;
  out.source = part.source;
  out.way = Vec3(way);
  out.wi = Vec3(way * (1 / distance));
  out.pdf = own / sums.back() * float(sqr(distance) * distance / (height * part.area));
  return out;
}

float open_share_of_batch(const FarPointDraws& d, DrawnLightsScratch& s) {
  const size_t hits = d.hits.size(), n = std::min(pilots, 4 * hits);
  std::vector<Ray> rays;
  std::vector<float> weights;
  for (size_t k = 0; k < n; ++k) {
    const ShadowReceiver& r = d.hits.receivers[(2 * k + 1) * hits / (2 * n)];
    if (!d.points.set_chances(r, s.sums)) continue;
    const uint64_t a = hash_of(r.stream, k, purpose_pilot), b = mix64(a);
    const FarPoints::Point p = d.points.point(
        r, s.sums, unit_float(uint32_t(a)), unit_float(uint32_t(a >> 32)), unit_float(uint32_t(b)));
    if (p.source == nullptr) continue;
    const float cosine = dot(p.wi, r.normal);
    if (!(cosine > 0) || !(dot(p.wi, r.horizon) > 0)) continue;
    weights.push_back(luminance(far_radiance_of(*p.source, p.way)) * cosine / p.pdf);
    Ray& ray = rays.emplace_back();
    ray.origin = r.origin;
    ray.direction = p.wi;
  }
  std::vector<uint8_t> is_occluded(rays.size());
  d.scene.tracer.occluded(rays, is_occluded, Coherence::coherent);
  double all = 0, open = 0;
  for (size_t k = 0; k < rays.size(); ++k) {
    all += double(weights[k]);
    if (is_occluded[k] == 0) open += double(weights[k]);
  }
  const double count = double(rays.size()), share = all > 0 ? open / all : 0.5;
  return float((share * count + 1) / (count + 2));  // as if two more had met one of each
}

void draw_points(const FarPointDraws& d, std::span<const uint32_t> members, double open,
                 const DrawingBudget& budget, DrawnLightsScratch& s, RadianceBatch& out,
                 Counters& counters) {
  FarCounts counts(d.hits, members, budget, out.typical > 0,
                   clutter * rays_for_error(open, double(budget.error)), open);
  for (size_t i = 0; i < members.size(); ++i) {
    if (counts.is_first_of_pixel(i)) {
      counts.look_at_pixel(i);
      s.runs.push_back(s.draws.size());
    }
    const uint32_t m = members[i];
    const ShadowReceiver& r = d.hits.receivers[m];
    uint32_t first = 0;
    const uint32_t n = counts.of(i, first);
    ++counters.mixed;
    if (d.hits.is_first[m] != 0) out.sources[d.hits.indices[m]] += Rgb{1, 0, 0};
    if (!d.points.set_chances(r, s.sums)) continue;
    s.streams.assign(n, hash_combine(d.hits.draw_streams[m], purpose_points));
    s.samples.resize(n);
    s.numbers.resize(3 * size_t(n));
    for (uint32_t j = 0; j < n; ++j) s.samples[j] = first + j;
    sobol_groups(s.streams.data(), s.samples.data(), n, 0, 3, s.numbers.data());
    for (uint32_t j = 0; j < n; ++j) {
      DrawnLightsScratch::Draw& draw = s.draws.emplace_back();
      draw = {m, s.numbers[2 * n + j], {}, -1, {}};
      const FarPoints::Point p =
          d.points.point(r, s.sums, s.numbers[j], s.numbers[n + j], draw.place);
      if (p.source == nullptr) continue;
      const float cosine = dot(p.wi, r.normal);
      if (!(cosine > 0) || !(dot(p.wi, r.horizon) > 0)) continue;
      const Rgb value =
          d.hits.glossy[m] < 0
              ? Rgb{cosine}
              : glossy_value(d.hits.glossy_hits[size_t(d.hits.glossy[m])], p.wi,
                             d.competition.density(*p.source, r.position, r.horizon, p.wi));
      draw.light =
          d.hits.weights[m] * far_radiance_of(*p.source, p.way) * value * (1 / (p.pdf * float(n)));
      if (draw.light.is_black()) continue;
      draw.ray = int32_t(s.rays.size());
      Ray& ray = s.rays.emplace_back();
      ray.origin = r.origin;
      ray.direction = p.wi;
    }
    if (s.rays.size() >= most_waiting) {
      resolve_draws(d.scene, d.hits, s, out, counters);
      s.runs.push_back(0);
    }
  }
}

}  // namespace troffer
