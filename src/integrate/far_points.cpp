#include "integrate/far_points.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/random.h"
#include "base/simd.h"
#include "integrate/far_counts.h"
#include "shadow/pilot_rays.h"

namespace troffer {

namespace {

constexpr uint64_t purpose_points = 0x6661'7270, purpose_pilot = 0x6661'7271;
// A part gives so much of all light at most, or lies within a sine of its middle; and a cell is
// halved so often at most.
constexpr double most_share = 1.0 / 48, most_sine = 0.3;
constexpr int most_halvings = 8;
constexpr size_t most_waiting = 16384, pilots = 64;
// Where none of these arrives, so many; and where none of those does, so little light can that
// more points of a hit are not worth their time.
constexpr size_t few_pilots = 1024, most_pilots = 8192;
constexpr double most_of_closed = 16, most_of_closed_cell = 4;
// Of a hit's points, so many are a sun's.
constexpr uint32_t per_point_of_sun = 4;

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
  std::vector<Part> parts;
  parts.swap(parts_);
  if (parts.empty()) return;
  const size_t leaves = std::bit_ceil(std::max(parts.size(), size_t(2)));
  parts_.resize(leaves);
  plant(parts, 0, leaves);
  for (const Part& p : parts_) {
    x_.push_back(p.middle.x);
    y_.push_back(p.middle.y);
    z_.push_back(p.middle.z);
    sine_.push_back(p.sine);
    strength_.push_back(p.strength);
  }
}

void FarPoints::plant(std::span<Part> parts, size_t leaf, size_t leaves) {
  if (parts.empty()) return;
  if (leaves == 1) {
    parts_[leaf] = parts[0];
    return;
  }
  Box box;
  for (const Part& p : parts) box.grow(p.middle);
  const Vec3 e = box.extent();
  const size_t axis = e.x >= e.y && e.x >= e.z ? 0 : e.y >= e.z ? 1 : 2;
  std::stable_sort(parts.begin(), parts.end(),
                   [&](const Part& a, const Part& b) { return a.middle[axis] < b.middle[axis]; });
  const size_t half = (parts.size() + 1) / 2;
  plant(parts.first(half), leaf, leaves / 2);
  plant(parts.subspan(half), leaf + leaves / 2, leaves / 2);
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
  const double share = source.flat.is_disk ? 0.25 * pi : 1;
  const Part part{plane,       area * share,           &source, Vec3(way * (1 / distance)),
                  float(sine), float(strength * share)};
  (source.flat.is_disk ? suns_ : parts_).push_back(part);
}

namespace {

TROFFER_MULTIVERSION
void set_chances_of_parts(const Vec3& normal, size_t n, const float* __restrict x,
                          const float* __restrict y, const float* __restrict z,
                          const float* __restrict sine, const float* __restrict strength,
                          float* __restrict out) {
  const float nx = normal.x, ny = normal.y, nz = normal.z;
  for (size_t i = 0; i < n; ++i) {
    const float cosine = nx * x[i] + ny * y[i] + nz * z[i];
    // 1.01: no part of which some is above the horizon is left out
    const float reach = 1.01f * sine[i] + 1e-3f, least = 0.3f * reach;
    const float height = cosine > least ? cosine : least;
    out[i] = cosine + reach > 0 ? strength[i] * height : 0.0f;
  }
}

}  // namespace

bool FarPoints::set_chances(const ShadowReceiver& r, Chances& c) const {
  const size_t n = parts_.size();
  const bool is_known = c.of_node_.size() == 2 * n && c.of_sun_.size() == suns_.size() &&
                        c.normal_.x == r.normal.x && c.normal_.y == r.normal.y &&
                        c.normal_.z == r.normal.z;
  if (is_known) return c.all() + c.suns() > 0;
  c.normal_ = r.normal;
  c.of_node_.resize(2 * n);
  float* node = c.of_node_.data();
  if (n > 0)
    set_chances_of_parts(r.normal, n, x_.data(), y_.data(), z_.data(), sine_.data(),
                         strength_.data(), node + n);
  for (size_t i = n; i-- > 1;) node[i] = node[2 * i] + node[2 * i + 1];
  c.suns_ = 0;
  c.of_sun_.clear();
  for (const Part& p : suns_) {
    const float cosine = dot(r.normal, p.middle), reach = 1.01f * p.sine + 1e-3f;
    c.of_sun_.push_back(cosine + reach > 0 ? p.strength * std::max(cosine, 0.3f * reach) : 0.0f);
    c.suns_ += c.of_sun_.back();
  }
  return c.all() + c.suns() > 0;
}

FarPoints::Point FarPoints::point(const ShadowReceiver& r, const Chances& c, float u,
                                  float v) const {
  const float* node = c.of_node_.data();
  const size_t n = parts_.size();
  size_t i = 1;
  for (bool is_u = true; i < n; is_u = !is_u) {
    float& x = is_u ? u : v;
    const float left = node[2 * i], right = node[2 * i + 1], share = left / (left + right);
    const bool is_left = left > 0 && (x < share || !(right > 0));
    x = is_left ? x / share : (x - share) / (1 - share);
    x = std::clamp(x, 0.0f, one_minus_epsilon);
    i = 2 * i + (is_left ? 0 : 1);
  }
  if (!(node[i] > 0)) return {};
  Point out = point_of_part(parts_[i - n], r, u, v);
  out.pdf *= node[i] / c.all();
  out.place = (float(i - n) + u) / float(n);
  return out;
}

FarPoints::Point FarPoints::point_of_part(const Part& part, const ShadowReceiver& r, float u,
                                          float v) const {
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
  out.pdf = float(sqr(distance) * distance / (height * part.area));
  return out;
}

FarPoints::Point FarPoints::point_of_sun(size_t sun, const ShadowReceiver& r, float u,
                                         float v) const {
  Point out = point_of_part(suns_[sun], r, u, v);
  out.place = u;
  return out;
}

FarPoints::Point FarPoints::point_of_any(const ShadowReceiver& r, const Chances& c, float u,
                                         float v, float place) const {
  float target = place * (c.all() + c.suns());
  const float all = c.all() + c.suns();
  for (size_t k = 0; k < suns_.size(); ++k) {
    if (target < c.of_sun_[k] || (k + 1 == suns_.size() && !(c.all() > 0))) {
      Point out = point_of_sun(k, r, u, v);
      out.pdf *= c.of_sun_[k] / all;
      return out;
    }
    target -= c.of_sun_[k];
  }
  if (!(c.all() > 0)) return {};
  Point out = point(r, c, u, v);
  out.pdf *= c.all() / all;
  return out;
}

namespace {

// Of rays from the hits, those from number `first` to `last` of `all`: what they would bring.
struct Pilots {
  double all = 0, open = 0;  // light
  size_t count = 0;
  FarPoints::Chances chances;

  void cast(const FarPointDraws& d, size_t first, size_t last) {
    std::vector<Ray> rays;
    std::vector<float> weights;
    const size_t hits = d.hits.size();
    for (size_t k = first; k < last; ++k) {
      const ShadowReceiver& r =
          d.hits.receivers[(2 * (k - first) + 1) * hits / (2 * (last - first))];
      if (!d.points.set_chances(r, chances)) continue;
      const uint64_t a = hash_of(r.stream, k, purpose_pilot), b = mix64(a);
      const FarPoints::Point p =
          d.points.point_of_any(r, chances, unit_float(uint32_t(a)), unit_float(uint32_t(a >> 32)),
                                unit_float(uint32_t(b)));
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
    for (size_t k = 0; k < rays.size(); ++k) {
      all += double(weights[k]);
      if (is_occluded[k] == 0) open += double(weights[k]);
    }
    count += rays.size();
  }
};

// So many points of a pixel, or of a point's samples, err by the error of what arrives.
double points_of_pixel(const FarPointDraws& d, std::span<const uint32_t> members,
                       const FarShare& share, std::span<const float> seen, double error) {
  if (seen.empty()) return clutter * rays_for_error(share.open, error);
  constexpr size_t most_looks = 16;
  const size_t looks = std::min(members.size(), most_looks);
  double far = 0;
  FarPoints::Chances chances;
  for (size_t k = 0; k < looks; ++k)
    if (d.points.set_chances(d.hits.receivers[members[k * members.size() / looks]], chances))
      far += double(chances.all() + chances.suns()) / double(looks);
  // as the darker half of them has it
  std::vector<float> sorted(seen.begin(), seen.end());
  std::sort(sorted.begin(), sorted.end());
  const size_t half = (sorted.size() + 1) / 2;
  double others = 0;
  for (size_t i = 0; i < half; ++i) others += double(sorted[i]) / double(half);
  const double arrives = share.open * far + others;
  if (!(arrives > 0)) return 0;
  return clutter * rays_for_error(share.open, error * arrives / (share.open * far));
}

}  // namespace

FarShare open_share_of_batch(const FarPointDraws& d, bool is_shut_out) {
  Pilots p;
  size_t n = std::min(pilots, 4 * d.hits.size());
  p.cast(d, 0, n);
  const size_t most = std::clamp(2 * d.hits.size(), few_pilots, most_pilots);
  while (is_shut_out && !(p.open > 0) && p.all > 0 && n < most) {
    const size_t next = std::min(4 * n, most);
    p.cast(d, n, next);
    n = next;
  }
  const double count = double(p.count), share = p.all > 0 ? p.open / p.all : 0.5;
  // as if two more had met one of each
  return {(share * count + 1) / (count + 2),
          is_shut_out && !(p.open > 0) && p.count >= few_pilots / 2};
}

namespace {

// Points of the sky and images, or of a sun, from hits.
class PointDrawing {
 public:
  PointDrawing(const FarPointDraws& d, std::span<const uint32_t> members, FarCounts& counts,
               DrawnLightsScratch& s)
      : d_(d), members_(members), counts_(counts), s_(s) {}

  // sun: -1: of the sky and images.
  void draw(int sun, RadianceBatch& out, Counters& counters) {
    for (size_t i = 0; i < members_.size(); ++i) {
      if (counts_.is_first_of_pixel(i)) {
        counts_.look_at_pixel(i);
        s_.runs.push_back(s_.draws.size());
      }
      const uint32_t m = members_[i];
      const ShadowReceiver& r = d_.hits.receivers[m];
      uint32_t first = 0;
      const uint32_t n = counts_.of(i, sun < 0 ? 1 : per_point_of_sun, first);
      if (!d_.points.set_chances(r, chances_)) continue;
      if (!((sun < 0 ? chances_.all() : chances_.suns()) > 0)) continue;
      set_numbers(hash_combine(d_.hits.draw_streams[m], purpose_points + uint64_t(sun + 1)), n,
                  first);
      for (uint32_t j = 0; j < n; ++j) {
        const float u = s_.numbers[j], v = s_.numbers[n + j];
        connect(m,
                sun < 0 ? d_.points.point(r, chances_, u, v)
                        : d_.points.point_of_sun(size_t(sun), r, u, v),
                n);
      }
      if (s_.rays.size() < most_waiting) continue;
      resolve_draws(d_.scene, d_.hits, s_, out, counters);
      s_.runs.push_back(0);
    }
  }

 private:
  void set_numbers(uint64_t stream, uint32_t n, uint32_t first) {
    s_.streams.assign(n, stream);
    s_.samples.resize(n);
    s_.numbers.resize(2 * size_t(n));
    for (uint32_t j = 0; j < n; ++j) s_.samples[j] = first + j;
    sobol_groups(s_.streams.data(), s_.samples.data(), n, 0, 2, s_.numbers.data());
  }

  void connect(uint32_t m, const FarPoints::Point& p, uint32_t n) {
    DrawnLightsScratch::Draw& draw = s_.draws.emplace_back();
    draw = {m, p.place, {}, -1, {}};
    if (p.source == nullptr) return;
    const ShadowReceiver& r = d_.hits.receivers[m];
    const float cosine = dot(p.wi, r.normal);
    if (!(cosine > 0) || !(dot(p.wi, r.horizon) > 0)) return;
    const Rgb value =
        d_.hits.glossy[m] < 0
            ? Rgb{cosine}
            : glossy_value(d_.hits.glossy_hits[size_t(d_.hits.glossy[m])], p.wi,
                           d_.competition.density(*p.source, r.position, r.horizon, p.wi));
    draw.light =
        d_.hits.weights[m] * far_radiance_of(*p.source, p.way) * value * (1 / (p.pdf * float(n)));
    if (draw.light.is_black()) return;
    draw.ray = int32_t(s_.rays.size());
    Ray& ray = s_.rays.emplace_back();
    ray.origin = r.origin;
    ray.direction = p.wi;
  }

  const FarPointDraws& d_;
  std::span<const uint32_t> members_;
  FarCounts& counts_;
  DrawnLightsScratch& s_;
  FarPoints::Chances chances_;
};

}  // namespace

void draw_points(const FarPointDraws& d, std::span<const uint32_t> members, const FarShare& share,
                 std::span<const float> seen, const DrawingBudget& budget, DrawnLightsScratch& s,
                 RadianceBatch& out, Counters& counters) {
  double of_pixel = points_of_pixel(d, members, share, seen, double(budget.error));
  if (share.seems_closed)
    of_pixel = std::min(of_pixel, (out.typical > 0 ? most_of_closed : most_of_closed_cell) *
                                      double(budget.viewing_rays));
  // What little gets into what seems closed is left to a pixel's first rays, as if much did.
  FarCounts counts(d.hits, members, budget, out.typical > 0, std::max(of_pixel, 1.0),
                   share.seems_closed ? 0.5 : share.open);
  counters.mixed += members.size();
  for (const uint32_t m : members)
    if (d.hits.is_first[m] != 0) out.sources[d.hits.indices[m]] += Rgb{1, 0, 0};
  PointDrawing drawing(d, members, counts, s);
  for (int sun = -1; sun < int(d.points.suns()); ++sun) drawing.draw(sun, out, counters);
}

}  // namespace troffer
