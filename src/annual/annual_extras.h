// Results of `troffer annual` beside those of grids: glare at eyes, exposure to sunlight, electric
// light. Each list is empty unless asked for.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "annual/electric.h"
#include "annual/eye_glare.h"
#include "annual/sunlight.h"

namespace troffer {

// One eye in every hour of YearSkies, blinds as operated.
struct EyeYear {
  MeasuringPoint eye;  // its normal is the line of sight
  std::vector<float> vertical_lx, dgp;
  std::array<double, glare_limits.size()> shares{};  // of occupied hours above each limit
};

struct SunlitPoint {
  MeasuringPoint point;
  double hours = 0;
};

struct AnnualExtras {
  std::vector<EyeYear> eyes;
  SunlightDay sunlight_day;
  std::vector<SunlitPoint> sunlight;
  double electric_target_lx = 500;
  std::vector<ElectricLight> lights;  // per sensor of grids
  std::vector<DimmedUse> electric;
};

// Best level of protection from glare that an eye has, or "none" [EN 17037, annex E].
std::string glare_level(const EyeYear& eye);

}  // namespace troffer
