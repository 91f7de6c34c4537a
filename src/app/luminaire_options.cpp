#include "app/luminaire_options.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/units.h"
#include "import/attach_luminaire.h"
#include "import/file.h"
#include "light/web.h"

namespace troffer {

namespace {

constexpr double most_scale = 1e24;  // by which intensities can be multiplied to have a flux

// Twice the least angle from the nadir at which the mean over both directions of the plane at
// `turn` falls under a share of the largest intensity.
double full_angle_deg(const LightWeb& web, double share, double turn) {
  const float largest = largest_intensity(web);
  constexpr int steps = 1800;
  for (int i = 0; i <= steps; ++i) {
    const double height = pi * i / steps;
    float sum = 0;
    for (const double side : {turn, turn + pi})
      sum += intensity(web, Vec3(Vec3d{std::sin(height) * std::cos(side),
                                       std::sin(height) * std::sin(side), std::cos(height)}));
    if (double(sum) / 2 < share * double(largest)) return 2 * deg_from_rad(height);
  }
  return 360;
}

}  // namespace

void attach_luminaires(Scene& scene, const std::vector<std::string>& luminaires, const Vec3& down) {
  for (const std::string& text : luminaires) {
    const size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
      throw UsageError("--luminaire: '" + text + "' is not NODE=FILE or NODE=FILE,LUMENS");
    std::string file = text.substr(equals + 1);
    double lumens = 0;
    if (const size_t comma = file.rfind(','); comma != std::string::npos) {
      char* end = nullptr;
      lumens = std::strtod(file.c_str() + comma + 1, &end);
      if (*end == '\0' && comma + 1 < file.size()) {
        if (!(lumens > 0 && lumens <= 1e9))
          throw UsageError("--luminaire: lumens must lie between 0 and 1e9");
        file.resize(comma);
      } else {
        lumens = 0;
      }
    }
    const Luminaire luminaire = read_luminaire(file, scene.warnings);
    const double unit = scene.is_photometric ? 1 : 1 / luminous_efficacy;
    const double scale = lumens > 0 ? lumens / flux(luminaire.web) : 1;
    if (!(scale <= most_scale))
      throw UsageError(
          fmt::format("--luminaire: {} has too little light to be scaled to {} lm", file, lumens));
    attach_luminaire(scene, text.substr(0, equals), luminaire, unit * scale, down);
  }
}

bool is_luminaire(const std::string& path) {
  const std::string ending = lower_case_ending(path);
  return ending == "ies" || ending == "ldt";
}

std::string luminaire_info(const std::string& path, bool is_json) {
  WarningLog warnings;
  const Luminaire l = read_luminaire(path, warnings);
  const double lumens = flux(l.web);
  nlohmann::ordered_json j;
  j["luminaire"] = l.description;
  j["lumens"] = lumens;
  j["lamp_lumens"] = l.lamp_lumens;
  j["watts"] = l.watts;
  j["efficacy"] = l.watts > 0 ? lumens / l.watts : 0.0;
  j["largest_candela"] = largest_intensity(l.web);
  j["beam_angle"] = {full_angle_deg(l.web, 0.5, 0), full_angle_deg(l.web, 0.5, pi / 2)};
  j["field_angle"] = {full_angle_deg(l.web, 0.1, 0), full_angle_deg(l.web, 0.1, pi / 2)};
  j["opening"] = {l.width, l.length, l.height};
  j["is_round"] = l.is_round;
  j["warnings"] = nlohmann::ordered_json::array();
  for (const Warning& w : warnings.entries()) j["warnings"].push_back(w.text);
  if (is_json)
    return j.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
  std::string text = fmt::format(
      "luminaire  {}\nflux       {:.5g} lm (lamps {:.5g} lm)\npower      {:.4g} W, {:.4g} lm/W\n"
      "intensity  {:.5g} cd at most\nbeam       {:.1f} x {:.1f} degrees (half), {:.1f} x {:.1f} "
      "(a tenth)\nopening    {:.3g} x {:.3g} x {:.3g} m{}\n",
      l.description, lumens, l.lamp_lumens, l.watts, j["efficacy"].get<double>(),
      largest_intensity(l.web), j["beam_angle"][0].get<double>(), j["beam_angle"][1].get<double>(),
      j["field_angle"][0].get<double>(), j["field_angle"][1].get<double>(), l.width, l.length,
      l.height, l.is_round ? ", round" : "");
  for (const Warning& w : warnings.entries()) text += "warning    " + w.text + "\n";
  return text;
}

}  // namespace troffer
