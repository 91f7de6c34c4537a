// Points of all lights at infinity for hits that proofs are not worth: few of them, scattered, or
// where most of the sky is open anyway. No shafts, no lists, no exact light: small parts of the
// cells, chosen by the cosine of their middles, and a ray to a point of each.
//
// Unbiased. How many points a hit gets is chosen by 64 rays of its batch, which count for nothing
// else.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "integrate/drawn_lights.h"
#include "integrate/source_integrand.h"

namespace troffer {

class FarPoints {
 public:
  FarPoints() = default;
  // sources: those of lights at infinity, which must stay.
  explicit FarPoints(std::span<const CertifiedSource> sources);
  bool is_empty() const { return parts_.empty(); }

  // One point for a receiver, by u, v, place in [0,1).
  struct Point {
    const CertifiedSource* source = nullptr;  // null: none
    Vec3 way, wi;                             // from the receiver, metres; and the unit direction
    float pdf = 0;                            // per sr
  };
  // Sums of the parts' chances for a receiver; false where all of them are below its horizon.
  bool set_chances(const ShadowReceiver& receiver, std::vector<float>& sums) const;
  Point point(const ShadowReceiver& receiver, const std::vector<float>& sums, float u, float v,
              float place) const;

 private:
  struct Part {
    Parallelogram plane;
    double area = 0;
    const CertifiedSource* source = nullptr;
  };
  void add(const CertifiedSource& source, const Parallelogram& plane, double all, int halvings);
  std::vector<Part> parts_;
  std::vector<float> x_, y_, z_;  // of the directions of the middles
  std::vector<float> sine_;       // of the angle within which a part lies about its middle
  std::vector<float> strength_;   // luminance × sr
};

// The radiance that a point of a source at infinity sends.
Rgb far_radiance_of(const CertifiedSource& source, const Vec3& way);

struct FarPointDraws {
  const PreparedScene& scene;
  const LobeCompetition& competition;
  const WaitingHits& hits;
  const FarPoints& points;
};

// About what share of the light of all far sources arrives at the hits, between 1/66 and 65/66.
float open_share_of_batch(const FarPointDraws& draws, DrawnLightsScratch& scratch);

// Draws points from each of `members`: so many that they err by the budget's error, if the share
// `open` of the light arrives. Rays wait, as those of draw_lights().
void draw_points(const FarPointDraws& draws, std::span<const uint32_t> members, double open,
                 const DrawingBudget& budget, DrawnLightsScratch& scratch, RadianceBatch& out,
                 Counters& counters);

}  // namespace troffer
