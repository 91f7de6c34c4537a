// A scene of facets that answers by brute force in double precision, for tests of certified
// visibility.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/random.h"
#include "shadow/certified_light.h"

namespace troffer::test {

// Returns 1 if the open segment passes through the facet, clear of its edges by a relative margin,
// 0 if it clearly misses it, and -1 if it is too close to decide. Most tests ask without a margin,
// where signs suffice: then it takes no square roots.
inline int meets(const Vec3d& from, const Vec3d& to, const Quad& q, double margin) {
  const int n = is_triangle(q) ? 3 : 4;
  const Vec3d a(q[0]), normal = cross(Vec3d(q[1]) - a, Vec3d(q[2]) - a);
  if (!(dot(normal, normal) > 0)) return 0;
  const double h0 = dot(normal, from - a), h1 = dot(normal, to - a);
  // Times the length of `normal`, like h0 and h1.
  const double reach = margin > 0 ? length(to - from) * margin * length(normal) : 0;
  if ((h0 > reach && h1 > reach) || (h0 < -reach && h1 < -reach)) return 0;
  if (!((h0 > reach && h1 < -reach) || (h0 < -reach && h1 > reach))) return -1;
  const Vec3d p = from + (to - from) * (h0 / (h0 - h1));
  bool is_near = false;
  for (int i = 0; i < n; ++i) {
    const Vec3d v(q[size_t(i)]), w(q[size_t((i + 1) % n)]);
    const double side = dot(cross(w - v, p - v), normal);
    const double near = margin > 0 ? reach * length(w - v) : 0;
    if (side < -near) return 0;
    is_near = is_near || side < near;
  }
  return is_near ? -1 : 1;
}

class BruteForceScene final : public ShadowScene {
 public:
  std::vector<Quad> facets;
  bool is_complete = true;
  uint64_t segments = 0;

  void candidates(std::span<const Plane> planes, const Box&, const Box&, size_t most, uint64_t,
                  ShadowCandidates& out) override {
    out.facets.clear();
    out.is_complete = is_complete;
    out.is_too_long = false;
    for (uint32_t i = 0; i < facets.size(); ++i) {
      bool is_outside = false;
      for (const Plane& p : planes) {
        bool is_out_here = true;
        for (const Vec3& v : facets[i])
          is_out_here = is_out_here && dot(Vec3d(p.normal), Vec3d(v)) > double(p.distance);
        is_outside = is_outside || is_out_here;
      }
      if (is_outside) continue;
      if (out.facets.size() >= most) {
        out.is_complete = false;
        out.is_too_long = true;
        return;
      }
      out.facets.push_back({facets[i], i, false});
    }
  }
  void trace(std::span<const ShadowSegment> s, std::span<ShadowHit> hits) override {
    segments += s.size();
    for (size_t i = 0; i < s.size(); ++i) {
      hits[i] = {};
      for (uint32_t f = 0; f < facets.size() && hits[i].id == ray_is_free; ++f)
        if (meets(Vec3d(s[i].from), Vec3d(s[i].to), facets[f], 0) == 1) hits[i] = {f, 0.5f};
    }
  }
  void occluded(const SegmentArrays& s, std::span<uint8_t> is_hidden) override {
    segments += s.size();
    for (size_t i = 0; i < s.size(); ++i) {
      const Vec3d from(s.from[0][i], s.from[1][i], s.from[2][i]);
      const Vec3d end = from + Vec3d(s.way[0][i], s.way[1][i], s.way[2][i]);
      is_hidden[i] = std::any_of(facets.begin(), facets.end(),
                                 [&](const Quad& q) { return meets(from, end, q, 0) == 1; });
    }
  }
  Quad facet(uint32_t id) const override { return facets[id]; }
  double magnitude() const override {
    double m = 0;
    for (const Quad& q : facets)
      for (const Vec3& v : q)
        m = std::max({m, double(std::abs(v.x)), double(std::abs(v.y)), double(std::abs(v.z))});
    return m;
  }

  // Returns the result of `meets` for all facets together.
  int is_hidden(const Vec3d& from, const Vec3d& to, double margin) const {
    int answer = 0;
    for (const Quad& q : facets) {
      const int m = meets(from, to, q, margin);
      if (m == 1) return 1;
      if (m < 0) answer = -1;
    }
    return answer;
  }
};

inline Vec3 random_vector(Random& r, float size) {
  const float x = r.next_float() - 0.5f, y = r.next_float() - 0.5f;
  return Vec3{x, y, r.next_float() - 0.5f} * (2 * size);
}

inline Quad parallelogram_facet(const Vec3& corner, const Vec3& u, const Vec3& v) {
  return {corner, corner + u, corner + u + v, corner + v};
}

// Returns a source of random shape around (0,0,2), facing roughly down.
inline FlatSource random_source(Random& r) {
  FlatSource s;
  const double size = std::pow(10.0, -1.5 + 2 * r.next_double());
  const Vec3d u = Vec3d(random_vector(r, 1)) + Vec3d{1, 0, 0};
  const Vec3d v = Vec3d(random_vector(r, 1)) + Vec3d{0, 1, 0};
  s.plane.u = u * size;
  s.plane.v = v * (size * (0.2 + r.next_double()));
  s.plane.origin = Vec3d{0, 0, 2} - (s.plane.u + s.plane.v) * 0.5;
  s.plane.normal = normalize(cross(u, v));
  if (s.plane.normal.z > 0) s.plane.normal = -s.plane.normal;
  if (r.next_float() < 0.3f) s.outline = {{0, 0}, {1, 0}, {0, 1}};
  return s;
}

// Returns receivers near (0,0,0) that look up: in one plane, or scattered with individual normals.
inline std::vector<ShadowReceiver> random_receivers(Random& r, size_t n) {
  const float size = std::pow(10.0f, -3 + 3 * r.next_float());
  const bool is_flat = r.next_float() < 0.7f;
  const Vec3 normal =
      r.next_float() < 0.5f ? Vec3{0, 0, 1} : normalize(Vec3{0, 0, 1} + random_vector(r, 0.5f));
  const Vec3 along = normalize(cross(normal, Vec3{0.3f, 1, 0.2f})), across = cross(normal, along);
  std::vector<ShadowReceiver> receivers;
  for (size_t i = 0; i < n; ++i) {
    ShadowReceiver x;
    x.normal = x.horizon = normal;
    x.position = along * (size * (r.next_float() - 0.5f)) + across * (size * r.next_float());
    if (!is_flat) {
      x.position += random_vector(r, size);
      x.normal = x.horizon = normalize(normal + random_vector(r, 0.3f));
    }
    x.origin = x.position + x.normal * 4e-6f;
    x.stream = r.next_u64();
    receivers.push_back(x);
  }
  return receivers;
}

// Adds occluders of all kinds: plates, wires, specks, long walls, facets that touch the receivers
// or cross the source, duplicates and combs.
inline void add_random_facets(Random& r, BruteForceScene& scene) {
  const int n = 1 + int(r.next_float() * 8);
  for (int i = 0; i < n; ++i) {
    const float kind = r.next_float();
    Vec3 corner = random_vector(r, 1) + Vec3{0, 0, 1};
    Vec3 u = random_vector(r, 1), v = random_vector(r, 1);
    if (kind < 0.2f) {  // wire of about 1 mm
      v = normalize(v) * 1e-3f;
      u = u * 3.0f;
    } else if (kind < 0.35f) {  // speck
      u = u * 0.01f;
      v = v * 0.01f;
    } else if (kind < 0.5f) {  // level plate near the receivers or the source
      corner.z = r.next_float() < 0.5f ? 1e-3f + 0.05f * r.next_float() : 1.95f;
      u.z = v.z = 0;
      u = u * 2.0f;
    } else if (kind < 0.6f) {  // a wall through everything
      corner = {random_vector(r, 0.3f).x, -5, -1};
      u = {0, 10, 0};
      v = {random_vector(r, 0.2f).x, 0, 5};
    } else if (kind < 0.7f) {  // stands on the receivers' plane
      corner.z = 0;
      corner = corner * 0.1f;
      u.z = 0;
      v = {0, 0, 0.5f};
    } else if (kind < 0.8f) {  // covers most of the source
      corner = {-3, -3, 0.5f + r.next_float()};
      u = {6, 0, 0};
      v = {0, 6, 0};
    }
    Quad q = parallelogram_facet(corner, u, v);
    if (r.next_float() < 0.3f) q[3] = q[2];
    if (r.next_float() < 0.5f) std::swap(q[0], q[2]);
    if (is_triangle(q) || q[2].x != q[3].x) scene.facets.push_back(q);
    if (r.next_float() < 0.1f) scene.facets.push_back(q);
  }
  if (r.next_float() < 0.1f) {  // a comb of 64 bars
    for (int i = 0; i < 64; ++i)
      scene.facets.push_back(
          parallelogram_facet({-1 + float(i) / 32, -1, 1.2f}, {1.0f / 64, 0, 0}, {0, 2, 0}));
  }
}

inline LightRequest request_for(const FlatSource& source, FoundFacets& found) {
  return {&source, nullptr, 1, 1, &found};
}
inline LightRequest request_for(const SphereSource& source, FoundFacets& found) {
  return {nullptr, &source, 1, 1, &found};
}

// Evaluates one source for a cluster, rays included. Sets `out` and returns the counters.
template <class Source>
CertifiedCounters evaluate_alone(const CertifiedOptions& options, const Source& source,
                                 std::span<const ShadowReceiver> receivers, ShadowScene& scene,
                                 FoundFacets& found, std::span<SourceVisibility> out,
                                 ShadowIntegrand* integrand = nullptr) {
  ShadowCluster cluster;
  cluster.set(receivers);
  const LightRequest request = request_for(source, found);
  CertifiedMemory memory;
  certified_light(cluster, {&request, 1}, integrand, scene, options, memory,
                  [&](uint32_t, std::span<const SourceVisibility> answers) {
                    std::copy(answers.begin(), answers.end(), out.begin());
                  });
  return memory.counters;
}

}  // namespace troffer::test
