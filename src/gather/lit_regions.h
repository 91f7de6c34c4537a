// Lit regions: spheres around cells that are much brighter than the mean. Examples are a patch of
// sun on a floor, or a lit room behind a door that is ajar. Few cosine-distributed gather rays meet
// such a region, and those few bring most of the light. So a part of the rays is guided to lit
// regions, and every ray is weighted by the density of both kinds together. The mean does not
// depend on the guiding, and no ray counts more than `1 / least_by_cosine` times.
//
// The noise is least if the density of rays is proportional to the root mean square of what they
// bring [1]. Used for records, viewing rays and sensors alike.
//
// References: [1] Kahn & Marshall, "Methods of Reducing Sample Size in Monte Carlo Computations",
// 1953.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/frame.h"
#include "base/rgb.h"
#include "base/vec.h"
#include "cells/cell_hit.h"
#include "trace/tracer.h"

namespace troffer {

// Hit of one pilot gather ray.
struct PilotHit {
  CellHit hit;
  uint32_t cell = 0;
  float share = 0;   // weight of the ray among all pilot rays, by what its viewing ray carries
  float weight = 0;  // luminance of the irradiance that it brings, over that of the cell
};

// A lit region: a sphere around bright cells.
struct LitRegion {
  Vec3 centre;
  float radius = 0;
  Vec3 normal;            // mean over its surfaces: short where these face different ways
  float mean_square = 0;  // mean square irradiance of one ray that meets the region
};

// Pilot hits within one lit region: the targets of visibility tests.
struct LitRegionHits {
  static constexpr size_t most = 8;

  std::array<CellHit, most> hits;
  uint32_t count = 0;
};

// Visibility of all lit regions from some places.
struct RegionVisibility {
  std::vector<float> visible;  // per region: visible share × light found / light expected
  float rest = 0;              // mean square of the irradiance that other rays bring
};

class LitRegions {
 public:
  static constexpr size_t most_places = 128;
  static constexpr size_t most_tries = most_places * LitRegionHits::most;

  LitRegions() = default;
  // Finds lit regions among the cells that the pilot has seen; none where brightness is even.
  // irradiance: per cell. cell_size: metres. The tracer must outlive it.
  LitRegions(const Tracer& tracer, std::vector<PilotHit> seen, std::span<const Rgb> irradiance,
             float cell_size);

  std::span<const LitRegion> all() const { return places_; }
  // Returns the visibility of each region before any gather ray is traced: its mean over some of
  // the places `from`, tested by about `rays` rays in all.
  RegionVisibility visibility_from(std::span<const CellHit> from, size_t rays = most_tries) const;

 private:
  const Tracer* tracer_ = nullptr;
  std::vector<LitRegion> places_;
  std::vector<LitRegionHits> hits_;  // one per lit region
  float rest_ = 0;
};

// Distribution of the gather rays from one place.
class GatherDistribution {
 public:
  // Least share of rays drawn by the cosine.
  static constexpr float least_by_cosine = 0.5f;

  // The cosine distribution.
  GatherDistribution() = default;
  GatherDistribution(const LitRegions& places, std::span<const float> visible, float rest,
                     const CellHit& at);
  GatherDistribution(const LitRegions& places, const RegionVisibility& sight, const CellHit& at)
      : GatherDistribution(places, sight.visible, sight.rest, at) {}

  // Returns the direction of a ray. weight: what the ray counts, relative to a cosine-distributed
  // one.
  Vec3 direction(const CellHit& at, Vec2 number, float& weight) const;
  // Returns the density of a direction, per steradian.
  float density(const CellHit& at, const Vec3& direction) const;
  bool is_towards_bright(const Vec3& direction) const { return density_towards(direction) > 0; }
  // Mean over cosine-distributed rays of the squared irradiance of those towards lit regions, as
  // expected from the pilot.
  float expected() const { return expected_; }

 private:
  struct Cone {
    Frame frame;
    float height = 0;   // 1 - cosine of the half angle
    float share = 0;    // share of rays
    float density = 0;  // share over solid angle, per steradian
  };

  float density_towards(const Vec3& direction) const;

  float by_cosine_ = 1, expected_ = 0;
  std::vector<Cone> cones_;
};

// Statistics of the first rays from some places. They correct the distribution of later rays, but
// not that of the first rays themselves, whose mean stays unbiased.
class GuidingStatistics {
 public:
  // Adds a ray. irradiance: the luminance that it brought, weight included.
  void add(const GatherDistribution& aim, const Vec3& direction, float weight, float irradiance);
  // Corrects `sight` by what the rays have brought.
  void tell(RegionVisibility& sight) const;

 private:
  double rest_ = 0, rest_rays_ = 0, bright_ = 0, expected_ = 0;
};

}  // namespace troffer
