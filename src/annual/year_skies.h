// Skies and suns of a year: what stands outside the scene in every hour with daylight. Hours are
// those time steps of the weather file in whose middle the sun is up.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "daylight/reinhart_sky.h"
#include "lighting/weather_year.h"

namespace troffer {

// Luminances of one subdivision, patch by patch: a run of hours for each.
struct PatchHours {
  ReinhartSky sky;
  std::vector<float> luminance;  // cd/m²
  std::span<const float> of(size_t patch, size_t hours) const {
    return std::span(luminance).subspan(patch * hours, hours);
  }
};

struct YearSkies {
  std::vector<uint32_t> steps;    // indices into WeatherYear::steps
  PatchHours coarse;              // for reflected light (outside_sources.h)
  PatchHours fine;                // for light straight from the sky
  std::vector<float> ground;      // luminance below the horizon, cd/m²
  std::vector<float> sun_lx;      // illuminance of a plane that faces the sun
  std::vector<float> diffuse_lx;  // horizontal illuminance of the sky

  size_t hours() const { return steps.size(); }
};

// Makes Perez' skies (daylight/sky_model.h) of all hours. Memory: 4 bytes per hour and patch.
YearSkies make_year_skies(const WeatherYear& year, int subdivision, double ground_reflectance,
                          int threads);

}  // namespace troffer
