// Points of all lights at infinity for hits that proofs are not worth: few of them, scattered, or
// where most of the sky is open anyway. No shafts, no lists, no exact light: small parts of the
// cells, chosen by the cosine of their middles, a few points of every sun, and a ray to each.
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
  bool is_empty() const { return parts_.empty() && suns_.empty(); }

  // One point for a receiver.
  struct Point {
    const CertifiedSource* source = nullptr;  // null: none
    Vec3 way, wi;                             // from the receiver, metres; and the unit direction
    float pdf = 0;                            // per sr
    float place = 0;                          // of its part among all, in [0,1)
  };
  // The parts' chances for receivers of one normal, as a tree: nodes of a heap, the root being 1.
  class Chances {
   public:
    // Of skies and images, and of suns: light that nothing hides, about.
    float all() const { return of_node_.empty() ? 0 : of_node_[1]; }
    float suns() const { return suns_; }

   private:
    friend class FarPoints;
    Vec3 normal_;
    std::vector<float> of_node_, of_sun_;
    float suns_ = 0;
  };
  // False where all parts are below the receiver's horizon. What is there for the same normal
  // stays.
  bool set_chances(const ShadowReceiver& receiver, Chances& chances) const;
  // Of skies and images, by (u, v) in [0,1)²: even points become points that are as even, since
  // every branch of the tree goes on with its share of u or v. chances.all() is over 0.
  Point point(const ShadowReceiver& receiver, const Chances& chances, float u, float v) const;
  // Of one of the suns.
  size_t suns() const { return suns_.size(); }
  Point point_of_sun(size_t sun, const ShadowReceiver& receiver, float u, float v) const;
  // Of either, suns by `place` in [0,1).
  Point point_of_any(const ShadowReceiver& receiver, const Chances& chances, float u, float v,
                     float place) const;

 private:
  struct Part {
    Parallelogram plane;
    double area = 0;
    const CertifiedSource* source = nullptr;
    Vec3 middle;         // direction from the scene
    float sine = 0;      // of the angle within which the part lies about it
    float strength = 0;  // luminance × sr
  };
  void add(const CertifiedSource& source, const Parallelogram& plane, double all, int halvings);
  // Puts parts into leaves from `leaf` on, neighbours together.
  void plant(std::span<Part> parts, size_t leaf, size_t leaves);
  Point point_of_part(const Part& part, const ShadowReceiver& receiver, float u, float v) const;
  std::vector<Part> parts_;  // by leaf of the tree, some of them empty
  std::vector<Part> suns_;
  // Per leaf.
  std::vector<float> x_, y_, z_, sine_, strength_;
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
