#include "report/groups.h"

#include <algorithm>
#include <map>

#include "base/error.h"
#include "base/suggestion.h"
#include "base/units.h"
#include "base/wildcard.h"
#include "render/source_info.h"
#include "report/plan_view.h"
#include "scene/names.h"

namespace troffer {

namespace {

// Strips a number at the end: "panel.003", "panel 3" and "panel3" become "panel".
std::string family_of(const std::string& name) {
  const size_t end = name.find_last_not_of("0123456789");
  if (end == std::string::npos || end + 1 == name.size()) return name;
  const size_t letters = name.find_last_not_of(" ._-", end);
  return letters == std::string::npos ? name : name.substr(0, letters + 1);
}

std::vector<ReportedLights> single_luminaires(const Scene& scene,
                                              const std::vector<PowerRequest>& power) {
  const std::vector<SourceInfo> infos = source_infos(scene);
  const double lm = scene.is_photometric ? 1 : luminous_efficacy;
  std::map<std::string, size_t> number;
  std::vector<ReportedLights> groups;
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& e = scene.lights[i];
    const auto [at, is_new] = number.emplace(e.name, groups.size());
    if (is_new) {
      groups.emplace_back();
      ReportedLights& g = groups.back();
      g.name = e.name;
      g.lights = {e.name};
      g.luminaires = 1;
      g.is_daylight = is_daylight(e);
    }
    if (!groups[at->second].is_daylight) groups[at->second].lumens += infos[i].power * lm;
  }
  for (const PowerRequest& r : power) {
    bool is_used = false;
    for (ReportedLights& g : groups) {
      if (g.is_daylight || !fits_wildcard(g.name, r.name)) continue;
      g.watts = r.watts;
      is_used = true;
    }
    if (!is_used)
      throw UsageError("--power: no luminaire is named '" + r.name + "'" +
                       did_you_mean(r.name, light_names(scene)));
  }
  return groups;
}

void join(ReportedLights& to, const ReportedLights& g) {
  const bool is_known = to.luminaires == 0 || to.watts.has_value();
  to.lights.insert(to.lights.end(), g.lights.begin(), g.lights.end());
  to.luminaires += g.luminaires;
  to.lumens += g.lumens;
  to.is_daylight = g.is_daylight;
  if (is_known && g.watts)
    to.watts = to.watts.value_or(0) + *g.watts;
  else
    to.watts.reset();
}

std::vector<ReportedLights> families(const std::vector<ReportedLights>& singles) {
  std::map<std::string, size_t> number;
  std::vector<ReportedLights> groups;
  for (const ReportedLights& g : singles) {
    const std::string name = g.is_daylight ? g.name : family_of(g.name);
    const auto [at, is_new] = number.emplace(name, groups.size());
    if (is_new) groups.push_back({name, {}, 0, false, 0, std::nullopt});
    join(groups[at->second], g);
  }
  return groups;
}

}  // namespace

bool is_daylight(const Light& light) {
  return light.kind >= LightKind::distant;
}

std::vector<ReportedLights> light_groups(const Scene& scene, const std::vector<PowerRequest>& power,
                                         size_t most) {
  std::vector<ReportedLights> groups = single_luminaires(scene, power);
  std::stable_sort(groups.begin(), groups.end(),
                   [](const ReportedLights& a, const ReportedLights& b) {
                     return natural_less(a.name, b.name);
                   });
  if (groups.size() <= most) return groups;
  groups = families(groups);
  std::vector<ReportedLights> strong;
  std::stable_sort(groups.begin(), groups.end(),
                   [](const ReportedLights& a, const ReportedLights& b) {
                     return a.is_daylight != b.is_daylight ? a.is_daylight : a.lumens > b.lumens;
                   });
  for (const ReportedLights& g : groups) {
    if (strong.size() < most)
      strong.push_back(g);
    else {
      if (strong.size() == most) strong.push_back({"others", {}, 0, false, 0, std::nullopt});
      join(strong.back(), g);
    }
  }
  return strong;
}

Scene with_daylight_apart(Scene scene) {
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    if (!is_daylight(scene.lights[i])) continue;
    while (std::any_of(scene.lights.begin(), scene.lights.end(), [&](const Light& e) {
      return !is_daylight(e) && e.name == scene.lights[i].name;
    }))
      scene.lights[i].name += " (daylight)";
  }
  return scene;
}

std::pair<std::vector<std::string>, std::vector<std::string>> daylight_and_luminaires(
    const Scene& scene) {
  std::pair<std::vector<std::string>, std::vector<std::string>> names;
  for (const Light& e : scene.lights) {
    std::vector<std::string>& list = is_daylight(e) ? names.first : names.second;
    if (std::find(list.begin(), list.end(), e.name) == list.end()) list.push_back(e.name);
  }
  return names;
}

}  // namespace troffer
