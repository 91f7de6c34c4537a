// A look at what of the light from infinity arrives at a batch of hits, by rays that count for
// nothing else: it decides what is proved and how many rays are cast.
#pragma once

#include "certified/far_points.h"
#include "trace/occluders.h"
#include "transport/prepared_scene.h"

namespace troffer {

// What share of the light of far sources arrives at the hits of a batch, about. Not 0 or 1.
struct FarShare {
  double open = 0.5;                      // of all of it
  double open_sky = 0.5, open_sun = 0.5;  // of skies and images, of suns
  // Mean variance of what two rays from one hit to the same sun say.
  double spread_of_sun = 0.25;
  // … and of what suns send to the hits of one pixel, and skies and images.
  double spread_in_pixel = 0, spread_of_sky_in_pixel = 0;
  bool seems_closed = false;  // shut out, and of many rays none has arrived
  // Much of it arrives, and almost every ray that does not has met another facet: lists of what is
  // in the way are long, and prove little.
  bool is_behind_clutter = false;
};

// Whether light can come from there; and the ray that asks.
inline bool is_above(const ShadowReceiver& r, const Vec3& wi) {
  return dot(wi, r.normal) > 0 && dot(wi, r.horizon) > 0;
}
inline Ray far_ray(const ShadowReceiver& r, const Vec3& wi) {
  Ray ray;
  ray.origin = r.origin;
  ray.direction = wi;
  return ray;
}

struct FarPointDraws {
  const PreparedScene& scene;
  const LobeCompetition& competition;
  const WaitingHits& hits;
  const FarPoints& points;
  const Occluders& occluders;
};

// By rays that count for nothing else. is_shut_out: nothing arrives, as it seems; then it is looked
// at more closely.
FarShare open_share_of_batch(const FarPointDraws& draws, bool is_shut_out);

}  // namespace troffer
