// Measured distributions: intensity by direction, the flux they add up to, and the radiance of the
// luminous opening that they leave.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/vec.h"
#include "scene/light_web.h"

namespace troffer {

// Intensity in the unit direction w of the luminaire's own axes, linear in both angles.
float intensity(const LightWeb& web, const Vec3& w);

// Integral of the intensity over all directions, exactly for what intensity() returns.
double flux(const LightWeb& web);

float largest_intensity(const LightWeb& web);

// Of the opening's front faces as seen from w, m²: all of what is seen of a convex one. At least a
// hundredth of its largest face, so that flat ones keep within bounds edge on.
float projected_area(const LightWeb& web, const Vec3& w);

// Radiance in the direction w of every point of the opening that is seen from there: far away these
// add up to the intensity.
inline float radiance(const LightWeb& web, const Vec3& w) {
  return intensity(web, w) / projected_area(web, w);
}

// Memory for WebLookup.
struct WebLanes {
  std::vector<float> height, turn, area;
  std::vector<int32_t> height_step, turn_step;
  std::vector<float> height_share, turn_share;
};

// A web with tables that find the steps of its angles without a search.
class WebLookup {
 public:
  explicit WebLookup(const LightWeb& web);  // which must stay where it is

  // radiance() of n points of the opening at (x, y, z) from a receiver, which they are seen from;
  // the luminaire's axes are these of the world. Several times faster, and in the last bits
  // different.
  void radiance_many(const std::array<Vec3, 3>& axes, size_t n, const float* x, const float* y,
                     const float* z, WebLanes& lanes, float* out) const;

 private:
  // Ascending angles, and buckets of equal width from the first to the last: of each, how many
  // angles behind the first lie in buckets before it.
  struct Steps {
    explicit Steps(const std::vector<float>& angles);
    void find(size_t n, const float* angles, int32_t* step, float* share) const;

    const std::vector<float>& angles;
    float buckets_per_radian = 0;
    std::vector<int32_t> before;
    int32_t most_within = 0;  // of the inner angles, in one bucket
  };

  const LightWeb& web_;
  Steps heights_, turns_;
};

// Radiance in many directions, for integrals over all of them.
class WebSamples {
 public:
  explicit WebSamples(const LightWeb& web);
  // Flux per area of a face of the opening whose unit normal, in the luminaire's axes, is n.
  double exitance(const Vec3& n) const;

 private:
  std::vector<Vec3> directions_;
  std::vector<float> weights_;  // radiance times solid angle
};

}  // namespace troffer
