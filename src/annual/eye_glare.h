// Daylight glare at eyes in every hour of a year, without pictures. Sources are the visible part of
// the sun's disc, patches of the sky, and surfaces in the sun. Light of the whole view comes from
// the transport, as the illuminance of a sensor that faces along the line of sight.
//
// Differences from `troffer glare`: neighbouring parts are not merged to sources, and a surface has
// the luminance that the sun straight gives it, without reflected light.
//
// References: [1] Wienold & Christoffersen, Energy and Buildings 38(7), 2006 (DGP).
//   [2] EN 17037:2018+A1:2021, annex E: DGP exceeded in at most 5 % of the hours of use.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "annual/sensor_hours.h"
#include "annual/year_times.h"

namespace troffer {

// Limits of DGP, and names of the level of protection that each stands for [2].
struct GlareLimit {
  double dgp = 0;
  const char* level = "";
};
inline constexpr std::array glare_limits{GlareLimit{0.35, "high"}, GlareLimit{0.40, "medium"},
                                         GlareLimit{0.45, "minimum"}};
constexpr double most_glare_share = 0.05;  // of the hours of use [2]

// Returns Σ L² ω / P² of all glare sources for every hour, in cd²/m⁴ sr, for light that arrives
// through one light path in one state. place: the eye; its normal is the line of sight. Threads may
// call it at the same time for different eyes.
std::vector<float> glare_strengths(const YearOfLight& light, size_t eye, const CellHit& place);

// DGP from the illuminance at the eye and the sum over sources, with evalglare's correction for low
// light.
double hourly_dgp(double vertical_lx, double strength);

// Share of occupied hours with a DGP above each limit.
std::array<double, glare_limits.size()> shares_of_glare(std::span<const float> dgp,
                                                        const YearTimes& times);

}  // namespace troffer
