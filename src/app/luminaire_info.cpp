#include "app/luminaire_info.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/polar_curve.h"
#include "app/printable.h"
#include "base/units.h"
#include "import/file.h"
#include "light/web.h"
#include "lighting/attached_luminaires.h"

namespace troffer {

namespace {

// Returns the angle, in the plane at `turn`, between the outermost directions on both sides of the
// beam whose intensity reaches a share of the largest one. For upward beams it is measured around
// the zenith.
double full_angle_deg(const LightWeb& web, double share, double turn) {
  constexpr int steps = 1800;
  const auto at = [&](double height, double side) {
    return double(intensity(web, Vec3(Vec3d{std::sin(height) * std::cos(side),
                                            std::sin(height) * std::sin(side), std::cos(height)})));
  };
  double below = 0, above = 0;
  for (int i = 0; i <= steps; ++i)
    for (int k = 0; k < 36; ++k) {
      double& most = 2 * i <= steps ? below : above;
      most = std::max(most, at(pi * i / steps, pi * k / 18));
    }
  const double least = share * double(largest_intensity(web)) * (1 - 1e-6);
  double sum = 0;
  for (const double side : {turn, turn + pi})
    for (int i = steps; i > 0; --i) {
      const double from_beam = pi * i / steps;
      if (at(below >= above ? from_beam : pi - from_beam, side) < least) continue;
      sum += deg_from_rad(from_beam);
      break;
    }
  return sum;
}

}  // namespace

bool is_luminaire(const std::string& path) {
  const std::string ending = lower_case_ending(path);
  return ending == "ies" || ending == "ldt";
}

std::string luminaire_info(const std::string& path, bool is_json, const std::string& polar) {
  WarningLog warnings;
  const Luminaire l = read_and_check_luminaire(path, warnings);
  if (!polar.empty()) write_polar_curve(polar, l.web);
  const double lumens = flux(l.web);
  nlohmann::ordered_json j;
  j["luminaire"] = l.description;
  j["lumens"] = lumens;
  j["lamp_lumens"] = l.lamp_lumens;
  j["is_absolute"] = l.is_absolute;
  j["watts"] = l.watts;
  j["efficacy"] = l.watts > 0 ? lumens / l.watts : 0.0;
  j["largest_candela"] = largest_intensity(l.web);
  j["beam_angle"] = {full_angle_deg(l.web, 0.5, 0), full_angle_deg(l.web, 0.5, pi / 2)};
  j["field_angle"] = {full_angle_deg(l.web, 0.1, 0), full_angle_deg(l.web, 0.1, pi / 2)};
  const Vec3d& size = l.opening.size;
  j["opening"] = {size.x, size.y, size.z};
  j["is_round"] = l.opening.is_round[0] || l.opening.is_round[1];
  j["warnings"] = nlohmann::ordered_json::array();
  for (const Warning& w : warnings.entries()) j["warnings"].push_back(w.text);
  if (is_json)
    return j.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
  const std::string lamps = l.lamp_lumens > 0 ? fmt::format("lamps {:.5g} lm", l.lamp_lumens)
                                              : std::string("lamp lumens not stated");
  const std::string power =
      l.watts > 0 ? fmt::format("{:.4g} W, {:.4g} lm/W", l.watts, j["efficacy"].get<double>())
                  : std::string("not stated");
  std::string text = fmt::format(
      "luminaire  {}\nflux       {:.5g} lm ({})\npower      {}\n"
      "intensity  {:.5g} cd at most\nbeam       {:.1f} x {:.1f} degrees (half), {:.1f} x {:.1f} "
      "(a tenth)\nopening    {:.3g} (C0) x {:.3g} (C90) x {:.3g} m{}\n",
      printable(l.description), lumens, l.is_absolute ? "absolute photometry" : lamps, power,
      largest_intensity(l.web), j["beam_angle"][0].get<double>(), j["beam_angle"][1].get<double>(),
      j["field_angle"][0].get<double>(), j["field_angle"][1].get<double>(), size.x, size.y, size.z,
      j["is_round"].get<bool>() ? ", round" : "");
  for (const Warning& w : warnings.entries()) text += "warning    " + printable(w.text) + "\n";
  return text;
}

}  // namespace troffer
