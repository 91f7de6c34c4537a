// Parts of sky patches, small enough that points can be sampled in them by the strengths of their
// corners. EnvironmentSampler (environment_sampler.h) samples them.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "certified/source_integrand.h"

namespace troffer {

// A parallelogram of directions from the scene's centre, in units of the distance to the part's
// face of the sky cube.
struct SkyPatchPart {
  const CertifiedSource* source = nullptr;
  Vec3 origin, u, v;
  float area = 0;
  Vec3 corner(size_t k) const {
    return origin + (k % 2 != 0 ? u : Vec3{}) + (k / 2 != 0 ? v : Vec3{});
  }
  Vec3 middle() const { return origin + (u + v) * 0.5f; }
  // Luminance × sr of the whole part if it were everywhere as at its corner k, divided by that
  // corner's distance. Multiplied by a corner's height over the horizon, it gives the light of a
  // receiver. Suns use the first entry only.
  std::array<float, 4> strength{};
};

struct SkyPatchParts {
  std::vector<SkyPatchPart> parts;  // parts of skies and images
  std::vector<SkyPatchPart> suns;   // one per sun
};

// Cuts the sky patches of environment lights into parts; `sources` must outlive them. Each part
// carries a small share of all light or is small as seen from the scene. Parts of images are also
// halved, most uneven first, until they are even within the limit, are single texels, or are very
// many.
//
// Samples chosen by root mean square and spread evenly within parts have the second moment (Σ root
// mean square × sr)². Perfect sampling has (Σ mean × sr)². Halving reduces the difference.
SkyPatchParts cut_far_parts(std::span<const CertifiedSource> sources);

// Returns the radiance of an environment source from the direction `way`, which need not be unit.
Rgb far_radiance_of(const CertifiedSource& source, const Vec3& way);

}  // namespace troffer
