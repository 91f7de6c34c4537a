// Points of all lights at infinity for hits that proofs are not worth: few of them, scattered, or
// where most of the sky is open anyway. No shafts, no lists, no exact light: small parts of the
// cells, chosen by the cosine of their middles, and a ray to a point of each.
//
// Unbiased. How many points a hit gets is chosen by rays of its batch, which count for nothing
// else: 64, or more where none of these arrives.
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
  // The parts' chances for receivers of one normal, with sums over blocks of them.
  class Chances {
   public:
    float all() const { return sums_.empty() ? 0 : sums_.back(); }

   private:
    friend class FarPoints;
    Vec3 normal_;
    std::vector<float> of_part_, sums_;  // padded with zeros; over the blocks so far
  };
  // False where all parts are below the receiver's horizon. What is there for the same normal
  // stays.
  bool set_chances(const ShadowReceiver& receiver, Chances& chances) const;
  Point point(const ShadowReceiver& receiver, const Chances& chances, float u, float v,
              float place) const;

 private:
  struct Part {
    Parallelogram plane;
    double area = 0;
    const CertifiedSource* source = nullptr;
  };
  void add(const CertifiedSource& source, const Parallelogram& plane, double all, int halvings);
  std::vector<Part> parts_;
  // Per part; padded to whole blocks with parts of no strength.
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

// What share of the light of all far sources arrives at the hits, by rays that count for nothing
// else.
struct FarShare {
  double open = 0.5;          // about; not 0 or 1
  bool seems_closed = false;  // shut out, and of many rays none has arrived
};
// is_shut_out: nothing arrives, as it seems; then it is looked at more closely.
FarShare open_share_of_batch(const FarPointDraws& draws, bool is_shut_out);

// Draws points from each of `members`: so many that they err by the budget's error of the light
// that arrives, if the share holds. seen: per member, luminance × sr of what other sources bring;
// empty: nothing. Rays wait, as those of draw_lights().
void draw_points(const FarPointDraws& draws, std::span<const uint32_t> members,
                 const FarShare& share, std::span<const float> seen, const DrawingBudget& budget,
                 DrawnLightsScratch& scratch, RadianceBatch& out, Counters& counters);

}  // namespace troffer
