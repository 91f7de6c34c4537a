// Shadow rays to Owen-Sobol points of a flat source: what fixed sampling and the reference cast.
#pragma once

#include <cstdint>
#include <vector>

#include "shadow/shadow_source.h"
#include "trace/ray.h"

namespace troffer::bench {

// Rays end this share of the way to the source, clear of its plane.
float ray_length(const FlatSource& s, const Vec3& origin);

// Moves a point of the unit square into the source's outline, keeping areas: along a fan of
// triangles, or onto the disk. For others it is the identity.
Vec2 onto_outline(const FlatSource& s, Vec2 uv);

// m²
double area_of(const FlatSource& s);

struct ShadowRays {
  std::vector<Ray> rays;
  std::vector<float> weights;  // cosine at the receiver times cosine at the source over distance²
  std::vector<Vec2> points;    // in (u,v) of the source's plane; only where asked for
  std::vector<uint8_t> is_hidden;
  // memory
  std::vector<float> numbers;
  std::vector<uint64_t> streams;
  std::vector<uint32_t> samples, starts, order;

  void clear() {
    rays.clear();
    weights.clear();
    points.clear();
  }
};

struct HitPoint {
  Vec3 position, normal, origin;
};

enum class RayOrder {
  as_drawn,
  compact  // packets of 16 go to compact parts of the source; wants a power of two
};

// Appends rays to points [first, first + n) of the set named `stream`, uniform in area. Where no
// weight is above 0 nothing is added, and it returns false.
bool add_shadow_rays(const FlatSource& s, const HitPoint& hit, uint64_t stream, uint32_t first,
                     uint32_t n, RayOrder order, bool keeps_points, ShadowRays& out);

// The light that a source's points send differs much from one to the other, as it is close to it.
bool is_near(const FlatSource& s, const Vec3& position);

// The same with points nearly uniform in solid angle (light/light_sample.h), from which sources
// close to the hit gain. piece: what `s` was made of.
bool add_shadow_rays_by_angle(const FlatSource& s, const LightPrimitive& piece, const HitPoint& hit,
                              uint64_t stream, uint32_t n, RayOrder order, ShadowRays& out);

}  // namespace troffer::bench
