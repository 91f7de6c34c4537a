// Rays of one sensor straight to sky, ground and sun. All states of a family (state_family.h) share
// them: only rays that meet the region of a state are traced in its own scene.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "annual/blinds.h"
#include "annual/open_rays.h"
#include "annual/reflected_light.h"
#include "annual/state_family.h"
#include "annual/sun_disc.h"
#include "annual/year_skies.h"

namespace troffer {

// Everything that all sensors and states share.
struct YearOutside {
  const WeatherYear& year;
  const YearSkies& skies;
  const Compass& compass;
  uint64_t seed = 0;

  Vec3 world(const Vec3d& d) const {
    return Vec3(compass.east * d.x + compass.north * d.y + compass.up * d.z);
  }
};

// Rays to patches of the fine sky: per patch, stratum of it and replicate. Then rays to the ground
// (mirrored patches of the coarse sky): per patch and replicate. Then per hour with sun: one ray to
// the disc per replicate, and rays to its rim. Where those to the rim disagree, an edge crosses the
// disc, and every replicate gets more rays. Rays of one patch or hour follow each other.
class DirectRays {
 public:
  enum class Parts { all, sun };

  // sensor: number among StateFamily::sensors.
  DirectRays(const YearOutside& outside, const StateFamily& family, size_t sensor, Parts parts);

  // Strata of a patch of the sky. Wide patches have several, so that their edges are as sharp.
  size_t strata() const { return side_ * side_; }
  size_t first_of_ground() const { return first_of_ground_; }
  size_t first_of_sun() const { return first_of_sun_; }
  // Hours that have rays to the sun.
  const std::vector<uint32_t>& sun_hours() const { return sun_hours_; }
  // Cosine at the sensor; at most 0 for directions from which it gets no light.
  float cosine(size_t ray) const { return rays_[ray].cosine; }
  // The same for the sun of sun_hours()[i]: that of its middle.
  float sun_cosine(size_t i) const { return cosine(first_of_sun_ + i * rays_of_sun); }
  // Returns the transmittance of panes on each ray to the sky and the ground in a state, as
  // luminance; 0 if something else is in the way. From first_of_sun() on follow, for each of the
  // sun_hours() and each replicate, the mean over the sun's disc. fixed: empty, or values to
  // subtract.
  std::vector<float> open_in(const StateOfFamily& state, std::span<const float> fixed = {}) const;
  // Returns the hours in which the sun reaches the sensor straight, by open_in(): the mean of all
  // replicates.
  std::vector<SunHour> sun_in(const StateOfFamily& state, std::span<const float> fixed = {}) const;

 private:
  static constexpr size_t rays_of_sun = sun_strata + rim_points;  // of an hour

  struct DirectRay {
    Vec3 direction;
    float cosine = 0;
  };

  void add_sky();
  void add_ground();
  void add_sun();
  void add(const Vec3& direction, float cosine) { rays_.push_back({direction, cosine}); }
  void trace();
  void find_sun(const Tracer& tracer, std::vector<float>& open) const;
  Vec3 to_sun(uint32_t hour) const;

  const YearOutside& outside_;
  const StateFamily& family_;
  size_t sensor_;
  CellHit place_;
  size_t side_;  // strata per side of a patch
  std::vector<DirectRay> rays_;
  size_t first_of_ground_ = 0, first_of_sun_ = 0;
  std::vector<uint32_t> sun_hours_;
  std::vector<float> open_;                       // in the first state
  std::vector<std::vector<uint32_t>> of_region_;  // rays that meet each region
};

}  // namespace troffer
