// Pilot rays that estimate how much environment light arrives at a batch of hits. They decide what
// is proved and how many rays are cast, and do not enter the result.
#pragma once

#include "certified/environment_sampler.h"
#include "trace/occluders.h"
#include "transport/prepared_scene.h"

namespace troffer {

// Estimated shares of unoccluded environment light that arrive at a batch's hits. The shares are
// never exactly 0 or 1.
struct EnvironmentShare {
  double open = 0.5;                      // share of all environment light
  double open_sky = 0.5, open_sun = 0.5;  // share of skies and images; share of suns
  // Mean variance of the visibility of one sun between two rays from one hit.
  double spread_of_sun = 0.25;
  // Variance of sun visibility, and of sky light, between the hits of one pixel, beyond that within
  // a hit.
  double spread_in_pixel = 0, spread_of_sky_in_pixel = 0;
  bool seems_closed = false;  // the scene seems shut out, and no pilot ray arrived
  // True if much light arrives and most occluded rays met different facets. Facet lists are then
  // long and prove little.
  bool is_behind_clutter = false;
};

// True if light from the direction wi can reach the receiver. far_ray() returns the shadow ray in
// that direction.
inline bool is_above(const ShadowReceiver& r, const Vec3& wi) {
  return dot(wi, r.normal) > 0 && dot(wi, r.horizon) > 0;
}
inline Ray far_ray(const ShadowReceiver& r, const Vec3& wi) {
  Ray ray;
  ray.origin = r.origin;
  ray.direction = wi;
  return ray;
}

// The batch of hits, and the environment lights and occluders that rays from it may meet.
struct EnvironmentSamplerInputs {
  const PreparedScene& scene;
  const NominalSourceDensity& competition;
  const WaitingHits& hits;
  const EnvironmentSampler& points;
  const Occluders& occluders;
};

// Estimates the shares by pilot rays. seems_shut_out: true if probably no environment light enters
// (lit_surfaces.h); then more rays are cast to confirm it.
EnvironmentShare estimate_environment_share(const EnvironmentSamplerInputs& draws,
                                            bool seems_shut_out);

}  // namespace troffer
