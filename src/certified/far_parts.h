// Small parts of the cells of lights at infinity, of which points are drawn (far_points.h).
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "certified/source_integrand.h"

namespace troffer {

// Directions are in units of the distance of the part's face of the cube.
struct FarPart {
  const CertifiedSource* source = nullptr;
  Vec3 origin, u, v;
  float area = 0;
  Vec3 corner(size_t k) const {
    return origin + (k % 2 != 0 ? u : Vec3{}) + (k / 2 != 0 ? v : Vec3{});
  }
  Vec3 middle() const { return origin + (u + v) * 0.5f; }
  // Luminance × sr of all of the part if it were as at its corners, (0,0) (1,0) (0,1) (1,1), over
  // their distance: times the height over a horizon it is what a receiver gets. Suns: the first.
  std::array<float, 4> strength{};
};

struct FarParts {
  std::vector<FarPart> parts;  // of skies and images
  std::vector<FarPart> suns;   // one of each
};

// sources: those of lights at infinity, which must stay. A part gives a small share of all light at
// most, or is small as seen from the scene; and parts of images are halved, the least even ones
// first, until they are even within, texels at the last, or there are very many. Points that are
// drawn by the parts' root mean square and evenly within them have a second moment of (sum of root
// mean square × sr)², where by the image itself it would be (sum of mean × sr)²: what halving makes
// less of is the difference of the two.
FarParts cut_far_parts(std::span<const CertifiedSource> sources);

// The radiance that a point of a source at infinity sends.
Rgb far_radiance_of(const CertifiedSource& source, const Vec3& way);

}  // namespace troffer
