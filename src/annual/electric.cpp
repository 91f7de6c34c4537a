#include "annual/electric.h"

#include <algorithm>
#include <set>

#include "base/error.h"
#include "base/wildcard.h"
#include "lighting/option_text.h"
#include "scene/names.h"

namespace troffer {

namespace {

constexpr double electric_error = 0.01;  // asked of measure(), relative

}  // namespace

std::vector<ElectricGroup> electric_groups(const Scene& scene,
                                           const std::vector<std::string>& texts) {
  const std::vector<std::string> names = light_names(scene);
  std::vector<ElectricGroup> groups;
  std::set<std::string> used;
  for (const std::string& text : texts) {
    ElectricGroup& g = groups.emplace_back(ElectricGroup{text, {}});
    for (const std::string& pattern : split_text(text, ',')) {
      const size_t before = g.lights.size();
      for (const std::string& name : names) {
        if (!fits_wildcard(name, pattern)) continue;
        if (!used.insert(name).second)
          throw UsageError("--electric: the light '" + name + "' is named twice");
        g.lights.push_back(name);
      }
      if (g.lights.size() == before)
        throw UsageError("--electric: " + no_light_named(scene, pattern));
    }
  }
  return groups;
}

std::vector<ElectricLight> measure_electric(const Scene& scene,
                                            const std::vector<ElectricGroup>& groups,
                                            const std::vector<MeasuringPoint>& points,
                                            uint64_t seed, int threads, const StopFlag& stop) {
  std::vector<ElectricLight> lights;
  for (const ElectricGroup& g : groups) {
    const PreparedScene lit(with_only_lights(scene, g.lights));
    MeasureOptions options;
    options.error = electric_error;
    options.seed = seed;
    options.threads = threads;
    const MeasureResult result = measure(lit, points, options, {}, stop);
    if (!result.is_complete) break;
    ElectricLight& out = lights.emplace_back(ElectricLight{g.name, {}, {}});
    for (const Measurement& m : result.values) {
      out.lx.push_back(m.illuminance_lx);
      out.error.push_back(m.standard_error);
    }
  }
  return lights;
}

DimmingYear::DimmingYear(const std::vector<ElectricLight>& lights, double target_lx)
    : lights_(lights),
      target_lx_(target_lx),
      sensors_(lights.size(), 0),
      electric_(lights.size(), 0),
      daylight_(lights.size()) {
  const size_t sensors = lights.empty() ? 0 : lights[0].lx.size();
  for (size_t s = 0; s < sensors; ++s) {
    double sum = 0, most = 0;
    int group = -1;
    for (size_t g = 0; g < lights.size(); ++g) {
      sum += lights[g].lx[s];
      if (lights[g].lx[s] <= most) continue;
      most = lights[g].lx[s];
      group = int(g);
    }
    group_of_.push_back(group);
    if (group < 0) continue;
    ++sensors_[size_t(group)];
    electric_[size_t(group)] += sum;
  }
}

void DimmingYear::add(size_t sensor, std::span<const float> daylight) {
  if (sensor >= group_of_.size() || group_of_[sensor] < 0) return;
  std::vector<double>& sum = daylight_[size_t(group_of_[sensor])];
  sum.resize(daylight.size(), 0);
  for (size_t h = 0; h < daylight.size(); ++h) sum[h] += double(daylight[h]);
}

std::vector<DimmedUse> DimmingYear::use(const YearTimes& times, int steps_per_hour) const {
  std::vector<DimmedUse> uses;
  for (size_t g = 0; g < lights_.size(); ++g) {
    DimmedUse& u = uses.emplace_back(DimmedUse{lights_[g].name, sensors_[g], 0, 0, 0});
    u.occupied_hours = double(times.occupied) / steps_per_hour;
    if (sensors_[g] == 0) {
      u.full_load_hours = u.occupied_hours;
      continue;
    }
    const auto n = double(sensors_[g]);
    u.mean_lx = electric_[g] / n;
    const auto output = [&](double daylight) {
      return std::clamp((target_lx_ - daylight) / u.mean_lx, 0.0, 1.0);
    };
    size_t lit = 0;
    double steps = 0;
    for (size_t h = 0; h < daylight_[g].size(); ++h) {
      if (times.is_occupied[h] == 0) continue;
      ++lit;
      steps += output(daylight_[g][h] / n);
    }
    steps += double(times.occupied - lit) * output(0);
    u.full_load_hours = steps / steps_per_hour;
  }
  return uses;
}

}  // namespace troffer
