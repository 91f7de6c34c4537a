#include "render/measurements_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace troffer {

namespace {

const char* const header =
    "x,y,z,nx,ny,nz,irradiance_r,irradiance_g,irradiance_b,illuminance_lx,standard_error\n";

void add_row(const MeasuringPoint& point, const Measurement& m, std::string& csv) {
  const auto& [p, n] = point;
  fmt::format_to(std::back_inserter(csv), "{},{},{},{},{},{},{:.7g},{:.7g},{:.7g},{:.7g},{:.4g}\n",
                 p.x, p.y, p.z, n.x, n.y, n.z, m.irradiance.r, m.irradiance.g, m.irradiance.b,
                 m.illuminance_lx, m.standard_error);
}

}  // namespace

std::string measurements_csv(const std::vector<MeasuringPoint>& points,
                             const std::vector<Measurement>& values) {
  std::string csv = header;
  for (size_t i = 0; i < std::min(points.size(), values.size()); ++i)
    add_row(points[i], values[i], csv);
  return csv;
}

std::string measurements_csv(const std::vector<MeasuringPoint>& points,
                             const MeasureResult& result) {
  std::string csv = header;
  for (size_t i = 0; i < points.size(); ++i)
    if (result.is_measured[i]) add_row(points[i], result.values[i], csv);
  return csv;
}

}  // namespace troffer
