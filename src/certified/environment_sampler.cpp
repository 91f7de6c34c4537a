#include "certified/environment_sampler.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "base/random.h"
#include "base/simd.h"

namespace troffer {

namespace {

constexpr float tiny = 1e-30f;
// Precomputed chances: number of normals along an edge of a cube face, and limit on normals ×
// parts. The number is halved above the limit.
constexpr size_t most_normals = 8, most_about = size_t(1) << 20;

}  // namespace

bool is_through_portal(const LightPrimitives& primitives, const CertifiedSource& source,
                       const Vec3& x, const Vec3& wi) {
  const Portal* portal = primitives[source.primitive].portal;
  return portal == nullptr || portal->shows(x, wi);
}

EnvironmentSampler::EnvironmentSampler(std::span<const CertifiedSource> sources) {
  auto [parts, suns] = cut_far_parts(sources);
  suns_ = std::move(suns);
  if (parts.empty()) {
    if (!suns_.empty()) make_chances_about();
    return;
  }
  const size_t leaves = std::bit_ceil(std::max(parts.size(), size_t(2)));
  parts_.resize(leaves);
  plant(parts, 0, leaves);
  for (const SkyPatchPart& p : parts_)
    for (size_t k = 0; k < 4; ++k) {
      const Vec3 corner = p.corner(k);
      x_[k].push_back(corner.x);
      y_[k].push_back(corner.y);
      z_[k].push_back(corner.z);
      strength_[k].push_back(p.strength[k]);
    }
  make_chances_about();
}

void EnvironmentSampler::plant(std::span<SkyPatchPart> parts, size_t leaf, size_t leaves) {
  if (parts.empty()) return;
  if (leaves == 1) {
    parts_[leaf] = parts[0];
    return;
  }
  Box box;
  for (const SkyPatchPart& p : parts) box.grow(p.middle());
  const Vec3 e = box.extent();
  const size_t axis = e.x >= e.y && e.x >= e.z ? 0 : e.y >= e.z ? 1 : 2;
  std::stable_sort(parts.begin(), parts.end(), [&](const SkyPatchPart& a, const SkyPatchPart& b) {
    return a.middle()[axis] < b.middle()[axis];
  });
  const size_t half = (parts.size() + 1) / 2;
  plant(parts.first(half), leaf, leaves / 2);
  plant(parts.subspan(half), leaf + leaves / 2, leaves / 2);
}

namespace {

// Adds a quarter of each part's light at one corner; 0 for a corner below the horizon.
TROFFER_MULTIVERSION
void add_chances(const Vec3& normal, size_t n, const float* __restrict x, const float* __restrict y,
                 const float* __restrict z, const float* __restrict strength,
                 float* __restrict out) {
  const float nx = normal.x, ny = normal.y, nz = normal.z;
  for (size_t i = 0; i < n; ++i) {
    const float height = nx * x[i] + ny * y[i] + nz * z[i];
    out[i] += 0.25f * strength[i] * (height > 0 ? height : 0.0f);
  }
}

TROFFER_MULTIVERSION
void set_branches(size_t n, const float* __restrict node, float* __restrict left,
                  float* __restrict first, float* __restrict inverse) {
  for (size_t i = 1; i < n; ++i) {
    // If neither child has any probability, share 1 keeps the search away from NaN.
    const float share = node[2 * i + 1] > 0 ? node[2 * i] / node[i] : 1.0f;
    left[i] = share;
    first[2 * i] = 0;
    first[2 * i + 1] = share;
    inverse[2 * i] = 1 / std::max(share, tiny);
    inverse[2 * i + 1] = 1 / std::max(1 - share, tiny);
  }
}

// Unit normal through (x, y), both in [-1,1], of a face of a cube. Faces are ordered by axis, the
// positive one first.
Vec3 on_cube(size_t face, float x, float y) {
  Vec3 v;
  const size_t axis = face / 2;
  v[axis] = face % 2 == 0 ? 1.0f : -1.0f;
  v[(axis + 1) % 3] = x;
  v[(axis + 2) % 3] = y;
  return normalize(v);
}

// Returns a sample in [0,1] with density proportional to the line from a to b, which must not both
// be 0.
float sample_line(float a, float b, float u) {
  const float root = std::sqrt(a * a + (b * b - a * a) * u);
  return std::min(u * (a + b) / std::max(a + root, tiny), 1.0f);
}

}  // namespace

// Computes inner nodes from the leaves.
void EnvironmentSampler::Chances::set_tree() {
  const size_t n = of_node_.size() / 2;
  float* node = of_node_.data();
  for (size_t i = n; i-- > 1;) node[i] = node[2 * i] + node[2 * i + 1];
  left_.resize(n);
  first_.resize(2 * n);
  inverse_.resize(2 * n);
  set_branches(n, node, left_.data(), first_.data(), inverse_.data());
}

void EnvironmentSampler::set_suns(const Vec3& normal, float reach_of_normals, Chances& c) const {
  c.suns_ = 0;
  c.of_sun_.clear();
  for (const SkyPatchPart& p : suns_) {
    const Vec3 middle = p.middle();
    const float cosine = dot(normal, normalize(middle));
    // The factor 1.01 keeps every sun that is partly above the horizon.
    const float reach = 0.505f * length(p.u + p.v) / length(middle) + 1e-3f + reach_of_normals;
    c.of_sun_.push_back(cosine + reach > 0 ? p.strength[0] * std::max(cosine, 0.3f * reach) : 0.0f);
    c.suns_ += c.of_sun_.back();
  }
}

void EnvironmentSampler::make_chances_about() {
  normals_ = parts_.size() * 6 * sqr(most_normals) <= most_about ? most_normals : most_normals / 2;
  for (size_t face = 0; face < 6; ++face)
    for (size_t j = 0; j < normals_; ++j)
      for (size_t i = 0; i < normals_; ++i) {
        const auto normal_at = [&](float x, float y) {
          const float scale = 2 / float(normals_);
          return on_cube(face, (float(i) + x) * scale - 1, (float(j) + y) * scale - 1);
        };
        const Vec3 middle = normal_at(0.5f, 0.5f);
        float reach = 0;  // largest distance of the square's normals from the middle one
        for (const float x : {0.0f, 1.0f})
          for (const float y : {0.0f, 1.0f})
            reach = std::max(reach, 1.001f * length(normal_at(x, y) - middle));
        about_.push_back(chances_within(middle, reach));
      }
}

EnvironmentSampler::Chances EnvironmentSampler::chances_within(const Vec3& normal,
                                                               float reach) const {
  const size_t n = parts_.size();
  Chances c;
  c.of_node_.assign(2 * n, 0.0f);
  for (size_t k = 0; k < 4; ++k)
    for (size_t p = 0; p < n; ++p) {
      const Vec3 corner{x_[k][p], y_[k][p], z_[k][p]};
      const float height = dot(normal, corner), most = reach * length(corner);
      const float about = height > most ? height : 0.5f * std::max(height + most, 0.0f);
      c.of_node_[n + p] += 0.25f * strength_[k][p] * about;
    }
  if (n > 0) c.set_tree();
  set_suns(normal, reach, c);
  return c;
}

const EnvironmentSampler::Chances& EnvironmentSampler::chances_about(const Vec3& normal) const {
  const Vec3 size = abs(normal);
  const size_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const size_t face = 2 * axis + (normal[axis] < 0 ? 1 : 0);
  const auto cell = [&](size_t other) {
    const float x = normal[(axis + other) % 3] / std::max(size[axis], tiny);
    return std::min(size_t(std::max(0.5f * (x + 1), 0.0f) * float(normals_)), normals_ - 1);
  };
  return about_[(face * normals_ + cell(2)) * normals_ + cell(1)];
}

bool EnvironmentSampler::set_chances(const ShadowReceiver& r, Chances& c) const {
  const size_t n = parts_.size();
  const bool is_known = c.of_node_.size() == 2 * n && c.of_sun_.size() == suns_.size() &&
                        c.normal_.x == r.normal.x && c.normal_.y == r.normal.y &&
                        c.normal_.z == r.normal.z;
  if (is_known) return c.all() + c.suns() > 0;
  c.normal_ = r.normal;
  c.of_node_.resize(2 * n);
  float* node = c.of_node_.data();
  std::fill_n(node + n, n, 0.0f);
  for (size_t k = 0; k < 4 && n > 0; ++k)
    add_chances(r.normal, n, x_[k].data(), y_[k].data(), z_[k].data(), strength_[k].data(),
                node + n);
  c.set_tree();
  set_suns(r.normal, 0, c);
  return c.all() + c.suns() > 0;
}

EnvironmentSampler::Choice EnvironmentSampler::choose(const Chances& c, float u, float v) const {
  const float* node = c.of_node_.data();
  const size_t n = parts_.size();
  size_t i = 1;
  const auto go_down = [&](float& x) {  // branch-free, as branches here cannot be predicted
    i = 2 * i + (x < c.left_[i] ? 0 : 1);
    x = std::min((x - c.first_[i]) * c.inverse_[i], one_minus_epsilon);
  };
  while (i < n) {
    go_down(u);
    if (i < n) go_down(v);
  }
  return {uint32_t(i - n), node[i] / c.all(), u, v};
}

EnvironmentSampler::Choice EnvironmentSampler::choose_any_sun(const Chances& c, float u, float v,
                                                              float place) const {
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

EnvironmentSampler::Point EnvironmentSampler::point(const Choice& c, const Vec3& normal) const {
  Point out;
  if (!(c.chance > 0)) return out;
  const SkyPatchPart& p = part(c.part);
  float a = c.u, b = c.v, density = 1;
  if (p.source->flat.is_disk) {
    const float radius = 0.5f * std::sqrt(a), angle = 2 * pi_f * b;
    a = 0.5f + radius * std::cos(angle);
    b = 0.5f + radius * std::sin(angle);
  } else {
    // Bilinear between the corners, like the part's probability.
    std::array<float, 4> g;
    for (size_t k = 0; k < 4; ++k) g[k] = p.strength[k] * std::max(dot(normal, p.corner(k)), 0.0f);
    a = sample_line(g[0] + g[2], g[1] + g[3], a);
    const float low = g[0] + (g[1] - g[0]) * a, high = g[2] + (g[3] - g[2]) * a;
    b = sample_line(low, high, b);
    density = (low + (high - low) * b) / (0.25f * ((g[0] + g[1]) + (g[2] + g[3])));
    if (!(density > 0)) return out;
  }
  const Vec3 way = p.origin + p.u * a + p.v * b;
  const float square = dot(way, way), distance = std::sqrt(square);
  out.source = p.source;
  out.way = way * float(p.source->far->height);
  out.wi = way * (1 / distance);
  out.inverse_pdf = p.area / (square * distance * c.chance * density);
  return out;
}

void EnvironmentSampler::radiance(std::span<const Point> points, std::vector<Rgb>& out) const {
  constexpr size_t most = 64;  // points evaluated together
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
