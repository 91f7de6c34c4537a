// Illuminance of one sensor in all hours of a year, replicate by replicate: light straight from sky
// and ground, sunlight at the sun's true positions, and reflected light.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "annual/blinds.h"
#include "annual/reflected_light.h"
#include "annual/year_skies.h"

namespace troffer {

// lx per replicate and hour, one replicate after the other.
struct SensorHours {
  size_t hours = 0;
  std::vector<float> total;
  std::vector<float> sun;  // part of `total` that comes straight from the sun

  std::span<const float> total_of(size_t replicate) const {
    return std::span(total).subspan(replicate * hours, hours);
  }
  std::span<const float> sun_of(size_t replicate) const {
    return std::span(sun).subspan(replicate * hours, hours);
  }
};

// Everything that all sensors share.
struct YearOfLight {
  const PreparedScene& scene;
  const WeatherYear& year;
  const YearSkies& skies;
  const Compass& compass;
  std::span<const ReflectedReplicate> reflected;
  uint64_t seed = 0;
};

// Computes a sensor. Any number of threads may do so for different sensors.
SensorHours sensor_hours(const YearOfLight& light, size_t sensor, const CellHit& place);

// Returns the hours in which the sun reaches a sensor straight, by the same rays as sensor_hours():
// the mean of all replicates. YearOfLight::reflected is not used.
std::vector<SunHour> sun_of_sensor(const YearOfLight& light, size_t sensor, const CellHit& place);

}  // namespace troffer
