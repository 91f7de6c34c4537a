// Illuminance of one sensor in one state, in all hours of a year, replicate by replicate: light
// straight from sky and ground, sunlight at the sun's true positions, and reflected light.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "annual/direct_rays.h"

namespace troffer {

// The results of one state.
struct YearOfLight {
  const PreparedScene& scene;
  const YearOutside& outside;
  std::span<const ReflectedReplicate> reflected;
};

// Hourly luminances, and their coefficients in lx per cd/m², by replicate.
struct LightTerm {
  const float* luminance = nullptr;
  std::array<float, size_t(replicate_count)> coefficients{};
};

// Some hours of a sensor in lx: for each replicate, a run of them.
struct RunOfHours {
  static constexpr size_t most = 512;  // so that all fits the processor's cache
  size_t first = 0, count = 0;         // hours
  std::array<std::array<float, most>, size_t(replicate_count)> total;
  std::array<std::array<float, most>, size_t(replicate_count)> sun;  // the part straight from it
};

// A sensor's light as a sum of products, from which any run of hours follows.
class SensorHours {
 public:
  // open: DirectRays::open_in() the state. All must outlive this.
  SensorHours(const YearOfLight& light, size_t sensor, const CellHit& place, const DirectRays& rays,
              std::span<const float> open);

  // Sets the values of out.first … out.first + out.count - 1. Runs must be asked for in order.
  void compute(RunOfHours& out);

 private:
  // Hour with sun, and sunlight of each replicate in lx.
  struct SunTerm {
    uint32_t hour = 0;
    std::array<float, size_t(replicate_count)> lx{};
  };

  void add_sky(const DirectRays& rays, std::span<const float> open);
  void add_ground(const DirectRays& rays, std::span<const float> open);
  void add_sun(const DirectRays& rays, std::span<const float> open);
  void add_reflected_sky(size_t sensor);
  double cosine_over(const ReinhartPatch& patch) const;
  void add(const float* luminance, const std::array<float, size_t(replicate_count)>& coefficients);
  void add_reflected_sun(RunOfHours& out) const;

  const YearOfLight& light_;
  size_t sensor_;
  CellHit place_;
  std::vector<LightTerm> terms_;
  std::vector<SunTerm> suns_;  // ordered by hour
  size_t next_sun_ = 0;        // first one that no run has reached
};

}  // namespace troffer
