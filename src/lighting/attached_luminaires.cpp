#include "lighting/attached_luminaires.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>

#include "base/error.h"
#include "base/wildcard.h"
#include "import/luminaire/attach_luminaire.h"
#include "import/spectra.h"
#include "light/web.h"

namespace troffer {

namespace {

constexpr double most_scale = 1e24;  // limit on the factor that gives intensities a flux

// Relative tolerance between the flux of the intensities and the flux that the file states.
constexpr double lumens_tolerance = 0.05;

// "NODE=FILE[,LUMENS[,KELVIN]]". Empty LUMENS before KELVIN stand for the file's.
struct LuminaireOption {
  std::string node, file;
  double lumens = 0;  // 0: the file's
  double kelvin = 0;  // 0: white
};

// Removes the number after the last comma from the text; false if there is none.
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
  const bool is_open = o.file.ends_with(',');
  if (is_open) o.file.pop_back();
  const bool has_kelvin = is_open || take_number(o.file, o.lumens);
  if (!has_kelvin) o.lumens = last;
  // Together with a colour, 0 lumens stand for the file's.
  if (!(o.lumens >= (has_kelvin ? 0 : 1e-30) && o.lumens <= 1e9))
    throw UsageError("--luminaire: lumens must lie between 0 and 1e9");
  if (!has_kelvin) return o;
  o.kelvin = last;
  if (!(o.kelvin >= 1000 && o.kelvin <= 40'000))
    throw UsageError("--luminaire: a colour temperature must lie between 1000 and 40000 K");
  return o;
}

// Parts of the scene that match a pattern, each once: lights or, if no light matches, surfaces.
struct FittingNodes {
  std::vector<std::string> names;
  bool are_lights = false;
};

FittingNodes nodes_fitting(const Scene& scene, const std::string& pattern) {
  FittingNodes nodes;
  std::set<std::string> known;
  const auto take = [&](const std::string& name) {
    if (fits_wildcard(name, pattern) && known.insert(name).second) nodes.names.push_back(name);
  };
  for (const Light& e : scene.lights) take(e.name);
  nodes.are_lights = !nodes.names.empty();
  if (nodes.are_lights) return nodes;
  for (const Mesh& m : scene.meshes) take(m.name);
  for (const Instance& i : scene.instances) take(i.name);
  return nodes;
}

bool is_named(const Scene& scene, const std::string& name) {
  const auto has_name = [&](const auto& part) { return part.name == name; };
  return std::any_of(scene.lights.begin(), scene.lights.end(), has_name) ||
         std::any_of(scene.meshes.begin(), scene.meshes.end(), has_name) ||
         std::any_of(scene.instances.begin(), scene.instances.end(), has_name);
}

// Attaches a luminaire to all matches. Surfaces that cannot hold one are skipped with a warning,
// unless none can.
void attach_to_all(Scene& scene, const std::string& pattern, const Luminaire& luminaire,
                   const Rgb& scale, const Vec3& down) {
  const FittingNodes nodes = nodes_fitting(scene, pattern);
  if (nodes.names.empty())
    throw UsageError("--luminaire: no name matches '" + pattern + "' (troffer info lists lights)");
  size_t attached = 0;
  std::string problem;
  for (const std::string& name : nodes.names) {
    try {
      attach_luminaire(scene, name, luminaire, scale, down);
      ++attached;
    } catch (const UsageError& error) {
      if (nodes.are_lights) throw;
      problem = error.what();
    }
  }
  if (attached == 0) throw UsageError(problem);
  if (attached < nodes.names.size())
    scene.warnings.add(fmt::format("{} ('{}' matches {} more, which stay unchanged)", problem,
                                   pattern, nodes.names.size() - attached));
}

}  // namespace

Luminaire read_and_check_luminaire(const std::string& path, WarningLog& warnings) {
  Luminaire l = read_luminaire(path, warnings);
  const double lumens = flux(l.web), stated = l.lamp_lumens * l.output_ratio;
  if (stated > 0 && std::abs(lumens - stated) > lumens_tolerance * stated)
    warnings.add(
        fmt::format("{}: its intensities add up to {:.5g} lm, but its lamps and light output ratio "
                    "give {:.5g} lm",
                    path, lumens, stated));
  else if (l.lamp_lumens > 0 && lumens > (1 + lumens_tolerance) * l.lamp_lumens)
    warnings.add(
        fmt::format("{}: its intensities add up to {:.5g} lm, but its lamps give {:.5g} lm", path,
                    lumens, l.lamp_lumens));
  return l;
}

Rgb luminaire_scale(const Scene& scene, const Luminaire& luminaire, const std::string& name,
                    double lumens, double kelvin) {
  const double unit = scene.is_photometric ? 1 : 1 / luminous_efficacy;
  const double scale = lumens > 0 ? lumens / flux(luminaire.web) : 1;
  if (!(scale <= most_scale))
    throw UsageError(fmt::format("{} has too little light to be scaled to {} lm", name, lumens));
  return (kelvin > 0 ? blackbody_emission(kelvin) : Rgb{1}) * float(unit * scale);
}

void attach_luminaires(Scene& scene, const std::vector<std::string>& luminaires, const Vec3& down) {
  std::set<std::string> nodes;
  for (const std::string& text : luminaires) {
    const LuminaireOption o = parse_luminaire(text);
    if (!nodes.insert(o.node).second)
      scene.warnings.add("--luminaire: '" + o.node + "' is given twice; the last file counts");
    const Luminaire luminaire = read_and_check_luminaire(o.file, scene.warnings);
    const Rgb scale = luminaire_scale(scene, luminaire, o.file, o.lumens, o.kelvin);
    if (o.node.find('*') == std::string::npos || is_named(scene, o.node))
      attach_luminaire(scene, o.node, luminaire, scale, down);
    else
      attach_to_all(scene, o.node, luminaire, scale, down);
  }
}

std::vector<std::pair<std::string, double>> watts_of_luminaires(
    const std::vector<std::string>& luminaires) {
  std::vector<std::pair<std::string, double>> watts;
  WarningLog ignored;  // warnings are issued when luminaires are attached
  for (const std::string& text : luminaires) {
    const LuminaireOption o = parse_luminaire(text);
    watts.emplace_back(o.node, read_luminaire(o.file, ignored).watts);
  }
  return watts;
}

}  // namespace troffer
