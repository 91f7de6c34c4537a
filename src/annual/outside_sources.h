// The sources of daylight outside a scene whose light is computed separately: patches of the sky,
// the ground below the horizon, and positions of the sun. Reflected light has one right-hand side
// per source. Directions are in world space.
#pragma once

#include <span>
#include <vector>

#include "base/random.h"
#include "daylight/reinhart_sky.h"
#include "daylight/sky_lights.h"

namespace troffer {

// A direction drawn from a source, and the illuminance of a plane facing it per unit of the source.
struct OutsideSample {
  Vec3 direction;
  float weight = 0;
};

// Patches (unit: 1 cd/m²), then the ground (1 cd/m²), then suns (1 lx on a plane facing them).
class OutsideSources {
 public:
  OutsideSources(const Compass& compass, std::span<const Vec3d> suns);

  size_t size() const { return sky_.size() + 1 + suns_.size(); }
  size_t ground() const { return sky_.size(); }
  size_t first_sun() const { return sky_.size() + 1; }
  const ReinhartSky& sky() const { return sky_; }

  // Adds stratified samples of a source to `out`: `count` of a patch or a sun, and one of each
  // mirrored patch of the ground, which is large. Weights are for the mean over all of them.
  void draw(size_t source, int count, Random& random, std::vector<OutsideSample>& out) const;
  // Returns the radiance that a ray leaving in this direction sees per unit of a source. A sun
  // counts as a disc of 5 degrees, since only rays by way of mirrors, glass and gloss use this.
  float radiance(size_t source, const Vec3& direction) const;

 private:
  Vec3 world(const Vec3d& d) const {
    return Vec3(compass_.east * d.x + compass_.north * d.y + compass_.up * d.z);
  }

  Compass compass_;
  ReinhartSky sky_{1};
  std::vector<Vec3> suns_;
};

// Returns a direction within the sun's disc around a unit direction.
Vec3 within_sun(const Vec3& to_sun, const Vec2& number);

}  // namespace troffer
