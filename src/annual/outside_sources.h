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

// Subdivision of the sky for reflected light. Tregenza's patches (1) are too wide: deep in rooms, a
// few of them behind the window make all the light (docs/log/annual.md).
constexpr int reflected_subdivision = 2;

// A direction drawn from a source, and the illuminance of a plane facing it per unit of the source.
struct OutsideSample {
  Vec3 direction;
  float weight = 0;
};

// Patches (unit: 1 cd/m²), then the ground (1 cd/m²), then suns (1 lx on a plane facing them).
class OutsideSources {
 public:
  OutsideSources(const Compass& compass, std::span<const Vec3d> suns,
                 int subdivision = reflected_subdivision);

  size_t size() const { return sky_.size() + 1 + suns_.size(); }
  size_t ground() const { return sky_.size(); }
  size_t first_sun() const { return sky_.size() + 1; }
  const ReinhartSky& sky() const { return sky_; }
  // All sources in an order in which neighbours mostly light the same windows: by azimuth, the
  // ground last.
  std::vector<uint32_t> by_azimuth() const;

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
  ReinhartSky sky_;
  std::vector<Vec3> suns_;
};

// Samples of some sources, drawn beforehand. Places choose among the drawings of a source, so that
// drawings are shared but no sample costs more than a look-up.
class DrawnSources {
 public:
  // Draws the sources of these numbers with `samples` per drawing.
  DrawnSources(const OutsideSources& sources, std::span<const uint32_t> numbers, int samples,
               uint64_t seed);
  // One drawing of source numbers[i].
  std::span<const OutsideSample> of(size_t i, Random& random) const {
    const size_t n = (begin_[i + 1] - begin_[i]) / drawings;
    return std::span(samples_).subspan(begin_[i] + (random.next_u32() % drawings) * n, n);
  }

 private:
  static constexpr size_t drawings = 64;  // of a source
  std::vector<size_t> begin_{0};
  std::vector<OutsideSample> samples_;
};

}  // namespace troffer
