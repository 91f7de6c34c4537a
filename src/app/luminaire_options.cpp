#include "app/luminaire_options.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "app/polar_curve.h"
#include "app/printable.h"
#include "base/error.h"
#include "base/units.h"
#include "import/attach_luminaire.h"
#include "import/file.h"
#include "import/spectra.h"
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

namespace {

// "NODE=FILE[,LUMENS[,KELVIN]]"
struct LuminaireOption {
  std::string node, file;
  double lumens = 0;  // 0: the file's
  double kelvin = 0;  // 0: white
};

// Takes a number behind the last comma off the text; false where there is none.
bool take_number(std::string& text, double& number) {
  const size_t comma = text.rfind(',');
  if (comma == std::string::npos || comma + 1 == text.size()) return false;
  char* end = nullptr;
  number = std::strtod(text.c_str() + comma + 1, &end);
  if (*end != '\0') return false;
  text.resize(comma);
  return true;
}

LuminaireOption parse_luminaire(const std::string& text) {
  const size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    throw UsageError("--luminaire: '" + text +
                     "' is not NODE=FILE, NODE=FILE,LUMENS or NODE=FILE,"
                     "LUMENS,KELVIN");
  LuminaireOption o;
  o.node = text.substr(0, equals);
  o.file = text.substr(equals + 1);
  double last = 0;
  if (!take_number(o.file, last)) return o;
  const bool has_kelvin = take_number(o.file, o.lumens);
  if (!has_kelvin) o.lumens = last;
  // With a colour lumens of 0 stand for the file's.
  if (!(o.lumens >= (has_kelvin ? 0 : 1e-30) && o.lumens <= 1e9))
    throw UsageError("--luminaire: lumens must lie between 0 and 1e9");
  if (!has_kelvin) return o;
  o.kelvin = last;
  if (!(o.kelvin >= 1000 && o.kelvin <= 40'000))
    throw UsageError("--luminaire: a colour temperature must lie between 1000 and 40000 K");
  return o;
}

}  // namespace

void attach_luminaires(Scene& scene, const std::vector<std::string>& luminaires, const Vec3& down) {
  for (const std::string& text : luminaires) {
    const LuminaireOption o = parse_luminaire(text);
    const Luminaire luminaire = read_luminaire(o.file, scene.warnings);
    const double unit = scene.is_photometric ? 1 : 1 / luminous_efficacy;
    const double scale = o.lumens > 0 ? o.lumens / flux(luminaire.web) : 1;
    if (!(scale <= most_scale))
      throw UsageError(fmt::format("--luminaire: {} has too little light to be scaled to {} lm",
                                   o.file, o.lumens));
    const Rgb colour = o.kelvin > 0 ? blackbody_emission(o.kelvin) : Rgb{1};
    attach_luminaire(scene, o.node, luminaire, colour * float(unit * scale), down);
  }
}

bool is_luminaire(const std::string& path) {
  const std::string ending = lower_case_ending(path);
  return ending == "ies" || ending == "ldt";
}

std::string luminaire_info(const std::string& path, bool is_json, const std::string& polar) {
  WarningLog warnings;
  const Luminaire l = read_luminaire(path, warnings);
  if (!polar.empty()) write_polar_curve(polar, l.web);
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
  const Vec3d& size = l.opening.size;
  j["opening"] = {size.x, size.y, size.z};
  j["is_round"] = l.opening.is_round[0] || l.opening.is_round[1];
  j["warnings"] = nlohmann::ordered_json::array();
  for (const Warning& w : warnings.entries()) j["warnings"].push_back(w.text);
  if (is_json)
    return j.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
  std::string text = fmt::format(
      "luminaire  {}\nflux       {:.5g} lm (lamps {:.5g} lm)\npower      {:.4g} W, {:.4g} lm/W\n"
      "intensity  {:.5g} cd at most\nbeam       {:.1f} x {:.1f} degrees (half), {:.1f} x {:.1f} "
      "(a tenth)\nopening    {:.3g} (C0) x {:.3g} (C90) x {:.3g} m{}\n",
      printable(l.description), lumens, l.lamp_lumens, l.watts, j["efficacy"].get<double>(),
      largest_intensity(l.web), j["beam_angle"][0].get<double>(), j["beam_angle"][1].get<double>(),
      j["field_angle"][0].get<double>(), j["field_angle"][1].get<double>(), size.x, size.y, size.z,
      j["is_round"].get<bool>() ? ", round" : "");
  for (const Warning& w : warnings.entries()) text += "warning    " + printable(w.text) + "\n";
  return text;
}

}  // namespace troffer
