// Gather rays of places with wide gloss. A share of them is drawn by the lobe, and all are weighted
// by the density of both kinds together (balance heuristic [1]). Cosine-distributed rays alone can
// have weights of hundreds of times their mean, such as in a lobe of width .25 seen at a cosine of
// .12. One such ray leaves a blot on all pixels that share it. Used by GatherPass and
// CellsIndirect.
//
// References: [1] Veach & Guibas, "Optimally Combining Sampling Techniques for Monte Carlo
// Rendering", 1995.
#pragma once

#include "base/frame.h"
#include "base/rgb.h"
#include "base/vec.h"
#include "bsdf/bsdf.h"
#include "gather/lit_regions.h"
#include "transport/walk.h"

namespace troffer {

class GatherLobe {
 public:
  // Largest share of rays drawn by the lobe.
  static constexpr float most_by_lobe = 0.5f;

  // No gloss: the aim alone draws rays.
  GatherLobe() = default;
  // specular, wo: in the shading frame of `normal`. matte, gloss: luminance that either part sends
  // on under surroundings of radiance 1.
  GatherLobe(const Bsdf& specular, const Vec3& normal, const Vec3& wo, float matte, float gloss);

  // Returns the factor from pi × radiance of a ray to the mean radiance that gloss shows, for a ray
  // that counts as much as a cosine-distributed one.
  Rgb share_of(const Vec3& direction) const;
  // Returns the direction of a ray. weight: what the ray counts, relative to a cosine-distributed
  // one; 0 if the lobe sends nothing there.
  Vec3 direction(const GatherDistribution& aim, const CellHit& at, Vec2 number, float lobe_number,
                 float& weight) const;
  // Share of rays drawn by the lobe.
  float by_lobe() const { return by_lobe_; }

 private:
  float second_moment() const;

  Bsdf specular_;
  Frame frame_;
  Vec3 wo_;
  Rgb scale_;
  float by_lobe_ = 0;
};

// Sends a gather ray out, by the walk's random numbers. Returns what it counts relative to a
// cosine-distributed ray, and multiplies the walk's throughput by it.
float set_out(const CellHit& from, const GatherDistribution& aim, const GatherLobe& lobe,
              Walk& walk);

}  // namespace troffer
