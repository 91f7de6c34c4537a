// Shadow rays to Owen-Sobol points of a flat source. Fixed sampling and the reference use them.
#pragma once

#include <cstdint>
#include <vector>

#include "shadow/shadow_source.h"
#include "trace/ray.h"

namespace troffer::bench {

// Returns the share of the way to the source at which rays end, clear of its plane.
float ray_length(const FlatSource& s, const Vec3& origin);

// Maps a point of the unit square into the source's outline, preserving areas: along a triangle
// fan, or onto the disk. For other shapes it is the identity.
Vec2 onto_outline(const FlatSource& s, Vec2 uv);

// Returns the source's area, m².
double area_of(const FlatSource& s);

// A batch of shadow rays.
struct ShadowRays {
  std::vector<Ray> rays;
  std::vector<float> weights;  // cosine at the receiver times cosine at the source over distance²
  std::vector<Vec2> points;    // (u,v) in the source's plane; only if requested
  std::vector<uint8_t> is_hidden;
  // scratch
  std::vector<float> numbers;
  std::vector<uint64_t> streams;
  std::vector<uint32_t> samples, starts, order;

  void clear() {
    rays.clear();
    weights.clear();
    points.clear();
  }
};

// A receiver. origin: where its rays start.
struct HitPoint {
  Vec3 position, normal, origin;
};

enum class RayOrder {
  as_drawn,
  compact  // packets of 16 go to compact parts of the source; n must be a power of two
};

// Appends rays to points [first, first + n) of the set `stream`, uniform by area. Returns false and
// adds nothing if no weight is above 0.
bool add_shadow_rays(const FlatSource& s, const HitPoint& hit, uint64_t stream, uint32_t first,
                     uint32_t n, RayOrder order, bool keeps_points, ShadowRays& out);

// True if the source is so close that the light from its points varies strongly.
bool is_near(const FlatSource& s, const Vec3& position);

// Does the same with points nearly uniform in solid angle (light/light_sample.h), which suits
// sources close to the hit. piece: the primitive that `s` was made from.
bool add_shadow_rays_by_angle(const FlatSource& s, const LightPrimitive& piece, const HitPoint& hit,
                              uint64_t stream, uint32_t n, RayOrder order, ShadowRays& out);

}  // namespace troffer::bench
