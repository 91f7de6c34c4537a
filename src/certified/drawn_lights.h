// Sampling of many lights for a cluster of hits. The lights that repay certificates are certified
// one by one. Of all others points are sampled, roughly in proportion to their unoccluded light,
// with one shadow ray each.
//
// Unbiased: the choice of lights depends only on positions, normals and radiances. The number of
// samples follows from the allowed error of a pixel, whose viewing rays share one Owen-Sobol
// sequence. Lights without certificates, such as curved or textured meshes, are always sampled,
// triangle by triangle. References: docs/method/certified-appendix.md, "Many lights".
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "certified/light_groups.h"
#include "certified/light_shares.h"
#include "certified/waiting_hits.h"

namespace troffer {

// Allowed standard error of a pixel's sampled light, relative to the unoccluded light of all
// lights, and what it is spent on.
struct DrawingBudget {
  float error = 0.01f;     // relative, per pixel
  float viewing_rays = 1;  // per pixel
  // For few lights: samples per hit where these cost less than certificates; 0: none.
  uint32_t draws = 0;
  uint32_t matte_draw_factor =
      1;  // factor on `draws` where no hit is glossy, as matte samples cost less
  uint32_t effort_divisor = 1;  // SampleRequest::effort_divisor
  float typical = 0;            // SampleRequest::typical_luminance
};

// The lights of a cluster by treatment: certified or sampled. Scratch memory and result of
// choose_lights().
struct ClusterLights {
  std::vector<float> estimates, near;  // per group, as LightGroups::estimate() returns them
  std::vector<uint8_t> is_certified;   // per group; 0: the group may be sampled
  std::vector<uint32_t> certified;     // group indices, ordered by source
  uint32_t draws = 0;                  // light samples per hit
  // Number of the random sequence. Clusters with different `draws` use different sequences;
  // otherwise two hits of one pixel could sample the same points.
  uint64_t sequence = 0;
  std::vector<uint32_t> order;  // scratch
};

// Decides which groups to certify and how many samples the rest gets. Groups without sources are
// always sampled, others only where lights are many. hits: number of hits in the ball.
void choose_lights(const LightGroups& groups, const ClusterBall& ball, size_t hits,
                   const DrawingBudget& budget, ClusterLights& out);

// Certifies all groups that have sources and may send light. Returns true if other groups remain to
// be sampled. certify_none() makes all groups sampled.
bool certify_all(const LightGroups& groups, ClusterLights& out);
void certify_none(ClusterLights& out);

// Returns a ball around the receivers of these hits. Precondition: `members` is not empty.
ClusterBall ball_about(const WaitingHits& hits, std::span<const uint32_t> members);

// Scratch memory of one thread: light samples whose shadow rays are pending.
struct DrawnLightsScratch {
  struct Draw {
    uint32_t hit;  // index in WaitingHits
    float place;   // random number in [0,1) that chose the light
    Rgb light;     // unoccluded contribution
    int32_t ray;   // index in `rays`; -1: no contribution
    Rgb expected;  // control variate: already added to the result, subtracted again here
  };
  std::vector<Draw> draws;
  std::vector<size_t> runs;                   // starts of new pixels or clusters in `draws`
  static constexpr size_t most_rays = 16384;  // pending rays that trigger tracing
  std::vector<Ray> rays;
  std::vector<uint8_t> is_occluded;
  PaneFactors factors;
  // Scratch of one cluster.
  std::vector<float> estimates, near;
  std::vector<float> of_groups;  // estimates of the sampled groups
  std::vector<uint32_t> groups;
  LightShares shares;
  // Scratch of one block of draws.
  std::vector<uint64_t> streams;
  std::vector<uint32_t> samples, primitives, hits, chosen;  // `chosen`: groups
  std::vector<float> numbers, u, v, pmfs, places;
  std::vector<Vec3> receivers;
  std::vector<LightSample> points;
  std::vector<uint8_t> is_valid;
  LightSampleScratch light_samples;
  // Terms of one run: place, and deviation from the expected value.
  std::vector<std::pair<float, float>> terms, sorted;
  std::vector<uint32_t> begins;  // of buckets of terms

  void resize(size_t n);
};

// The scene, its light groups, and the sources that the groups refer to.
struct DrawnLights {
  const PreparedScene& scene;
  const LightGroups& groups;
  std::span<const CertifiedSource> sources;
  const NominalSourceDensity& competition;
};

// Samples lights.draws points per member from the groups that are not certified; reorders
// `members`. Shadow rays are traced once `most_rays` are pending. resolve_draws() traces the rest
// and adds the light to `out`; `hits` must not change before that.
void draw_lights(const DrawnLights& world, const WaitingHits& hits, std::span<uint32_t> members,
                 const ClusterLights& lights, DrawnLightsScratch& scratch, RadianceBatch& out,
                 Counters& counters);
void resolve_draws(const PreparedScene& scene, const WaitingHits& hits, DrawnLightsScratch& scratch,
                   RadianceBatch& out, Counters& counters);

}  // namespace troffer
