// What bench_visibility looks at and measures against: the flat sources of a scene, the hits of a
// camera, and fixed sampling.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/random.h"
#include "base/warp.h"
#include "integrate/shadow_world.h"
#include "render/camera.h"
#include "shadow/certified.h"
#include "trace/occluders.h"
#include "trace/surface.h"
#include "trace/tracer.h"

namespace troffer::bench {

inline std::vector<FlatSource> flat_sources(const LightPrimitives& lights) {
  std::vector<FlatSource> sources;
  for (const LightPrimitive& p : lights.all())
    for (const bool is_back : {false, true}) {
      FlatSource source;
      if (is_back && !p.is_two_sided) continue;
      if (make_flat_source(p, is_back, source))
        sources.push_back(source);
      else
        fmt::print("  (a light that is not flat is left out)\n");
    }
  return sources;
}

struct Tile {
  std::vector<Vec3> positions, normals, origins;
  std::vector<uint32_t> pixels;
};

inline std::vector<Tile> hit_tiles(const Scene& scene, const Tracer& tracer, const Camera& camera,
                                   int width, int height, int count, int spp) {
  const ViewingCamera view(camera, width, height);
  const int tx = width / 8, ty = height / 8;
  std::vector<Tile> tiles;
  Random random(5);
  for (int c = 0; c < count; ++c) {
    const int t = int((double(c) + random.next_double()) / count * tx * ty);
    // tiles are numbered so that successive ones lie far apart
    const int at = int((int64_t(t) * 7919) % (tx * ty));
    Tile tile;
    for (int i = 0; i < 64 * spp; ++i) {
      const int px = at % tx * 8 + i / spp % 8, py = at / tx * 8 + i / spp / 8;
      const Ray ray = view.ray({float(px) + random.next_float(), float(py) + random.next_float()},
                               {0.5f, 0.5f});
      Hit hit;
      tracer.closest({&ray, 1}, {&hit, 1});
      if (!hit.is_valid()) continue;
      const Surface s = surface_at(scene, ray, hit);
      const Vec3 n =
          dot(s.geometric_normal, ray.direction) > 0 ? -s.geometric_normal : s.geometric_normal;
      tile.positions.push_back(s.position);
      tile.normals.push_back(n);
      tile.origins.push_back(offset_origin(s, n));
      tile.pixels.push_back(uint32_t(py * width + px) * uint32_t(spp) + uint32_t(i % spp));
    }
    tiles.push_back(std::move(tile));
  }
  return tiles;
}

// Rays end this share of the way to the source, clear of its plane.
inline float ray_length(const FlatSource& s, const Vec3& origin) {
  double m = 0;
  for (size_t a = 0; a < 3; ++a)
    m = std::max({m, std::abs(s.plane.origin[a]), double(std::abs(origin[a]))});
  const double height = dot(s.plane.normal, Vec3d(origin) - s.plane.origin);
  return float(std::max(1 - 2.5e-6 * m / height, 0.0));
}

// The visible share by n Owen-Sobol rays, ratio estimate; false where nothing can arrive.
struct FixedScratch {
  std::vector<Ray> rays;
  std::vector<float> weights, numbers;
  std::vector<uint8_t> hidden;
  std::vector<uint64_t> streams;
  std::vector<uint32_t> samples;
};

// Moves a point of the unit square into the source's outline, keeping areas: along a fan of
// triangles, or onto the disk.
inline void onto_outline(const FlatSource& s, float& u, float& v) {
  if (s.is_disk) {
    const Vec2 p = disk_from_square(Vec2{u, v});
    u = 0.5f + 0.5f * p.x;
    v = 0.5f + 0.5f * p.y;
    return;
  }
  const std::vector<Vec2>& o = s.outline;
  if (o.empty()) return;
  float all = 0, passed = 0;
  const auto area = [&](size_t i) {
    const Vec2 e = o[i] - o[0], f = o[i + 1] - o[0];
    return std::abs(e.x * f.y - e.y * f.x);
  };
  for (size_t i = 1; i + 1 < o.size(); ++i) all += area(i);
  for (size_t i = 1; i + 1 < o.size(); ++i) {
    const float share = area(i) / all;
    if (u < passed + share || i + 2 == o.size()) {
      const float along = std::min((u - passed) / share, 1.0f), out = std::sqrt(v);
      const Vec2 p = o[0] + ((o[i] - o[0]) * (1 - along) + (o[i + 1] - o[0]) * along) * out;
      u = p.x;
      v = p.y;
      return;
    }
    passed += share;
  }
}

inline bool prepare_fixed(const FlatSource& s, const Vec3& position, const Vec3& normal,
                          const Vec3& origin, uint64_t stream, uint32_t n, FixedScratch& f) {
  const Vec3d x(position), nn(normal);
  if (!(dot(s.plane.normal, x - s.plane.origin) > 0)) return false;
  f.streams.assign(n, stream);
  f.samples.resize(n);
  for (uint32_t i = 0; i < n; ++i) f.samples[i] = i;
  f.numbers.resize(2 * n);
  sobol_groups(f.streams.data(), f.samples.data(), n, 0, 2, f.numbers.data());
  const Vec3 o = Vec3(s.plane.origin - x), u(s.plane.u), v(s.plane.v);
  const size_t before = f.weights.size();
  float sum = 0;
  const Vec3 shift = position - origin;
  const float length = ray_length(s, origin);
  for (uint32_t i = 0; i < n; ++i) {
    float a = f.numbers[i], b = f.numbers[n + i];
    onto_outline(s, a, b);
    const Vec3 d = o + u * a + v * b;
    const float cosine = dot(d, normal), square = dot(d, d);
    const float w = cosine > 0 ? cosine / (square * square) : 0;
    f.weights.push_back(w);
    sum += w;
    Ray r;
    r.origin = origin;
    r.direction = d + shift;
    r.t_max = w > 0 ? length : 0.0f;
    f.rays.push_back(r);
  }
  if (sum > 0) return true;
  f.weights.resize(before);
  f.rays.resize(before);
  return false;
}

}  // namespace troffer::bench
