#include "integrate/far_points.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "base/random.h"
#include "base/simd.h"

namespace troffer {

namespace {

// A part gives so much of all light at most, or lies within a sine of its middle; and a cell is
// halved so often at most.
constexpr double most_share = 1.0 / 48, most_sine = 0.3;
constexpr int most_halvings = 8;
constexpr float tiny = 1e-30f;

Vec3d middle_of(const Parallelogram& p) {
  return p.origin + (p.u + p.v) * 0.5;
}

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
  const Vec3d corner = way + plane.origin - middle_of(plane);
  const double unit = 1 / height;
  const Part part{&source,
                  Vec3(corner * unit),
                  Vec3(plane.u * unit),
                  Vec3(plane.v * unit),
                  float(area * share * sqr(unit)),
                  Vec3(way * (1 / distance)),
                  float(sine),
                  float(strength * share)};
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

TROFFER_MULTIVERSION
void set_branches(size_t n, const float* __restrict node, float* __restrict left,
                  float* __restrict first, float* __restrict inverse) {
  for (size_t i = 1; i < n; ++i) {
    // without chance on either side nothing goes there, whatever is rounded
    const float share = node[2 * i + 1] > 0 ? node[2 * i] / node[i] : 1.0f;
    left[i] = share;
    first[2 * i] = 0;
    first[2 * i + 1] = share;
    inverse[2 * i] = 1 / std::max(share, tiny);
    inverse[2 * i + 1] = 1 / std::max(1 - share, tiny);
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
  c.left_.resize(n);
  c.first_.resize(2 * n);
  c.inverse_.resize(2 * n);
  set_branches(n, node, c.left_.data(), c.first_.data(), c.inverse_.data());
  c.suns_ = 0;
  c.of_sun_.clear();
  for (const Part& p : suns_) {
    const float cosine = dot(r.normal, p.middle), reach = 1.01f * p.sine + 1e-3f;
    c.of_sun_.push_back(cosine + reach > 0 ? p.strength * std::max(cosine, 0.3f * reach) : 0.0f);
    c.suns_ += c.of_sun_.back();
  }
  return c.all() + c.suns() > 0;
}

FarPoints::Choice FarPoints::choose(const Chances& c, float u, float v) const {
  const float* node = c.of_node_.data();
  const size_t n = parts_.size();
  size_t i = 1;
  const auto go_down = [&](float& x) {  // without branches, which no processor could foresee
    i = 2 * i + (x < c.left_[i] ? 0 : 1);
    x = std::min((x - c.first_[i]) * c.inverse_[i], one_minus_epsilon);
  };
  while (i < n) {
    go_down(u);
    if (i < n) go_down(v);
  }
  return {uint32_t(i - n), node[i] / c.all(), u, v};
}

FarPoints::Choice FarPoints::choose_any_sun(const Chances& c, float u, float v, float place) const {
  float target = place * c.suns();
  for (size_t k = 0; k < suns_.size(); ++k) {
    if (target < c.of_sun_[k] || k + 1 == suns_.size()) {
      Choice out = choose_sun(k, u, v);
      out.chance = c.of_sun_[k] / c.suns();
      return out;
    }
    target -= c.of_sun_[k];
  }
  return {};
}

FarPoints::Point FarPoints::point(const Choice& c) const {
  Point out;
  if (!(c.chance > 0)) return out;
  const Part& p = part(c.part);
  float a = c.u, b = c.v;
  if (p.source->flat.is_disk) {
    const float radius = 0.5f * std::sqrt(a), angle = 2 * pi_f * b;
    a = 0.5f + radius * std::cos(angle);
    b = 0.5f + radius * std::sin(angle);
  }
  const Vec3 way = p.origin + p.u * a + p.v * b;
  const float square = dot(way, way), distance = std::sqrt(square);
  out.source = p.source;
  out.way = way * float(p.source->far->height);
  out.wi = way * (1 / distance);
  out.inverse_pdf = p.area / (square * distance * c.chance);
  return out;
}

void FarPoints::radiance(std::span<const Point> points, std::vector<Rgb>& out) const {
  constexpr size_t most = 64;  // at a stroke
  std::array<std::array<float, most>, 6> a{};
  out.resize(points.size());
  for (size_t i = 0; i < points.size();) {
    const CertifiedSource* source = points[i].source;
    size_t n = 1;
    while (n < most && i + n < points.size() && points[i + n].source == source) ++n;
    if (source == nullptr || !source->is_textured) {
      std::fill_n(out.begin() + std::ptrdiff_t(i), n, source == nullptr ? Rgb{} : source->radiance);
    } else {
      for (size_t k = 0; k < n; ++k)
        for (size_t c = 0; c < 3; ++c) a[c][k] = points[i + k].way[c];
      far_radiance(*source->far, n, a[0].data(), a[1].data(), a[2].data(), a[3].data(), a[4].data(),
                   a[5].data());
      for (size_t k = 0; k < n; ++k) out[i + k] = {a[3][k], a[4][k], a[5][k]};
    }
    i += n;
  }
}

}  // namespace troffer
