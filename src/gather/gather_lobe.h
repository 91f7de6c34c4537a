// Gather rays of places with wide gloss: some are drawn by the lobe, and all count by the density
// of both kinds together (Veach & Guibas, "Optimally Combining Sampling Techniques for Monte Carlo
// Rendering", 1995: the balance heuristic). Of rays by the cosine alone, a lobe of width .25 seen
// at a cosine of .12 shows some for hundreds of times their mean: what such a ray meets is a blot
// on all pixels that share it.
#pragma once

#include "base/frame.h"
#include "base/rgb.h"
#include "base/vec.h"
#include "bsdf/bsdf.h"
#include "gather/bright_places.h"
#include "transport/walk.h"

namespace troffer {

class GatherLobe {
 public:
  static constexpr float most_by_lobe = 0.5f;

  // No gloss: rays are drawn as aimed.
  GatherLobe() = default;
  // specular, wo: in the shading frame of the normal. matte, gloss: luminance that surroundings of
  // radiance 1 send on by either part.
  GatherLobe(const Bsdf& specular, const Vec3& normal, const Vec3& wo, float matte, float gloss);

  // Of a ray that counts as one drawn by its cosine: mean radiance shown, over its pi × radiance.
  Rgb share_of(const Vec3& direction) const;
  // The direction of a ray, and what it counts, over one drawn by its cosine.
  Vec3 direction(const GatherAim& aim, const CellHit& at, Vec2 number, float lobe_number,
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

// Sends a gather ray out by the walk's numbers. Returns what its light counts, over that of a ray
// drawn by its cosine; the walk carries so much.
float set_out(const CellHit& from, const GatherAim& aim, const GatherLobe& lobe, Walk& walk);

}  // namespace troffer
