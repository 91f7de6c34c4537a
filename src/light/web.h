// Photometric webs: intensity by direction, total flux, and the radiance of the luminous opening
// that emits it. Intensities in W/sr or cd, areas in m².
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/vec.h"
#include "scene/light_web.h"

namespace troffer {

// Intensity in the unit direction w of the luminaire's axes, linear in both angles. 0 outside the
// measured angles.
float intensity(const LightWeb& web, const Vec3& w);

// Integral of intensity() over all directions, exact for the interpolated values.
double flux(const LightWeb& web);

float largest_intensity(const LightWeb& web);

// Projected area, in m², of the opening's front faces seen from direction w; exact for convex
// openings. At least a hundredth of the largest face, so that flat openings have finite radiance
// edge-on.
float projected_area(const LightWeb& web, const Vec3& w);

// Radiance in direction w of every point of the opening that is visible from there. From far away
// it adds up to the intensity.
inline float radiance(const LightWeb& web, const Vec3& w) {
  return intensity(web, w) / projected_area(web, w);
}

// Scratch memory of WebLookup.
struct WebLanes {
  std::vector<float> height, turn, area;
  std::vector<int32_t> height_step, turn_step;
  std::vector<float> height_share, turn_share;
};

// A web with lookup tables that find angle intervals without a search.
class WebLookup {
 public:
  explicit WebLookup(const LightWeb& web);  // `web` must outlive this object

  // Computes radiance() for n visible points of the opening, given as vectors (x, y, z) from a
  // receiver. axes: the luminaire's axes in world space. Several times faster than radiance(), with
  // differences in the last bits.
  void radiance_many(const std::array<Vec3, 3>& axes, size_t n, const float* x, const float* y,
                     const float* z, WebLanes& lanes, float* out) const;

 private:
  // Ascending angles, and buckets of equal width over their range. before[k]: number of angles
  // after the first that lie in buckets before k.
  struct Steps {
    explicit Steps(const std::vector<float>& angles);
    void find(size_t n, const float* angles, int32_t* step, float* share) const;

    const std::vector<float>& angles;
    float buckets_per_radian = 0;
    std::vector<int32_t> before;
    int32_t most_within = 0;  // largest number of inner angles in one bucket
  };

  const LightWeb& web_;
  Steps heights_, turns_;
};

// Radiance in many directions, for integrals over all of them.
class WebSamples {
 public:
  explicit WebSamples(const LightWeb& web);
  // Flux per area of a face of the opening whose unit normal is n in the luminaire's axes.
  double exitance(const Vec3& n) const;

 private:
  std::vector<Vec3> directions_;
  std::vector<float> weights_;  // radiance times solid angle
};

}  // namespace troffer
