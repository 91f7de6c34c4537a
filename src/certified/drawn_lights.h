// Many lights: for a cluster of hits, those that are worth it are treated by certificates, one by
// one; points of all the others are drawn, about in proportion to what they may send, and a ray to
// each tells whether it arrives.
//
// Which lights are drawn depends on positions, normals and radiances alone, so that the estimate
// is unbiased. How many points are drawn is chosen for the error that a pixel may make: its viewing
// rays share them, one Owen-Sobol sequence for all of them. Lights without certificates, such as
// curved or textured meshes, are always drawn, triangle by triangle.
// References: docs/certified.md, "Many lights".
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "certified/light_groups.h"
#include "certified/light_shares.h"
#include "certified/waiting_hits.h"

namespace troffer {

// Allowed standard error of a pixel's light by drawing, relative to what all lights would send it
// unoccluded, and how many viewing rays the pixel gets.
struct DrawingBudget {
  float error = 0.01f;
  float viewing_rays = 1;
  // Of few lights: points from each hit where that takes less than certificates; 0: no points.
  uint32_t draws = 0;
  uint32_t matte_times = 1;  // … so many times as many where no hit is glossy: they cost less there
  uint32_t effort_divisor = 1;  // SampleRequest::effort_divisor
  bool is_picture = false;      // SampleRequest::is_picture
};

// Which lights of a cluster are drawn; memory, and the result.
struct LightsOfCluster {
  std::vector<float> estimates, near;  // per group
  std::vector<uint8_t> is_certified;   // per group; the others are drawn
  std::vector<uint32_t> certified;     // groups, in the order of their sources
  uint32_t draws = 0;                  // points from each hit
  // Of the random numbers for them: clusters with other numbers of points from each hit have
  // another, or hits of one pixel in both would draw the same points.
  uint64_t sequence = 0;
  std::vector<uint32_t> order;  // memory
};

// Groups without sources are drawn in any case, others where they are many. hits: in the ball.
void choose_lights(const LightGroups& groups, const ClusterBall& ball, size_t hits,
                   const DrawingBudget& budget, LightsOfCluster& out);

// All of them that can be certified are, and false if no other sends anything; or none is.
bool certify_all(const LightGroups& groups, LightsOfCluster& out);
void certify_none(LightsOfCluster& out);

// A ball about the hits' receivers.
ClusterBall ball_about(const WaitingHits& hits, std::span<const uint32_t> members);

// Memory of one thread: points that wait to be looked at.
struct DrawnLightsScratch {
  struct Draw {
    uint32_t hit;  // in WaitingHits
    float place;   // among the lights, in [0,1)
    Rgb light;     // that arrives if nothing is in the way
    int32_t ray;   // -1: none arrives
    Rgb expected;  // what has been counted of it beforehand: taken off again
  };
  std::vector<Draw> draws;
  std::vector<size_t> runs;                   // where draws of another pixel, or cluster, begin
  static constexpr size_t most_rays = 16384;  // that wait
  std::vector<Ray> rays;
  std::vector<uint8_t> is_occluded;
  PaneFactors factors;
  // of a cluster
  std::vector<float> estimates, near;
  std::vector<float> of_groups;  // estimates of those that are drawn
  std::vector<uint32_t> groups;
  LightShares shares;
  // of a block of draws
  std::vector<uint64_t> streams;
  std::vector<uint32_t> samples, primitives, hits, chosen;  // `chosen`: groups
  std::vector<float> numbers, u, v, pmfs, places;
  std::vector<Vec3> receivers;
  std::vector<LightSample> points;
  std::vector<uint8_t> is_valid;
  LightSampleScratch light_samples;
  // of a run
  std::vector<std::pair<float, float>> terms;

  void resize(size_t n);
};

// What draws are made from: the scene's groups, and the sources that they name.
struct DrawnLights {
  const PreparedScene& scene;
  const LightGroups& groups;
  std::span<const CertifiedSource> sources;
  const LobeCompetition& competition;
};

// Draws lights.draws points from each of `members`, which is reordered, of the groups that are not
// certified. Rays are cast, and light is added to `out`, once many wait and by resolve_draws(),
// before which `hits` must stay.
void draw_lights(const DrawnLights& world, const WaitingHits& hits, std::span<uint32_t> members,
                 const LightsOfCluster& lights, DrawnLightsScratch& scratch, RadianceBatch& out,
                 Counters& counters);
void resolve_draws(const PreparedScene& scene, const WaitingHits& hits, DrawnLightsScratch& scratch,
                   RadianceBatch& out, Counters& counters);

}  // namespace troffer
