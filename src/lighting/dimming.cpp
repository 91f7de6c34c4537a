#include "lighting/dimming.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "base/error.h"
#include "base/wildcard.h"
#include "lighting/option_text.h"
#include "scene/names.h"

namespace troffer {

namespace {

constexpr double most_factor = 1e6;

// Names of environment lights (daylight/sky_lights.h).
constexpr std::array<std::string_view, 3> daylight_names{"sky", "sun", "environment"};

std::string_view name_of(const Light& e) {
  return e.name;
}
std::string_view name_of(std::string_view name) {
  return name;
}

struct Dim {
  std::string name;
  double factor = 1;
};

Dim parse_dim(const std::string& text) {
  const size_t equals = text.rfind('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    throw UsageError("--dim: '" + text + "' is not NAME=FACTOR");
  const auto factor = parse_number(text.substr(equals + 1));
  if (!factor || *factor < 0 || *factor > most_factor)
    throw UsageError("--dim: '" + text + "': its factor must be a number between 0 and 1e6");
  return {text.substr(0, equals), *factor};
}

}  // namespace

bool shines(const Scene& scene) {
  return std::any_of(scene.lights.begin(), scene.lights.end(), emits);
}

void dim_lights(Scene& scene, const std::vector<std::string>& dims) {
  for (const std::string& text : dims) {
    const Dim d = parse_dim(text);
    const auto fits = [&](const auto& named) { return fits_wildcard(name_of(named), d.name); };
    // The names of daylight are valid even at hours without it.
    if (std::none_of(scene.lights.begin(), scene.lights.end(), fits) &&
        std::none_of(daylight_names.begin(), daylight_names.end(), fits))
      throw UsageError("--dim: " + no_light_named(scene, d.name));
  }
  for (Light& e : scene.lights) {
    const auto factor = float(dimming_of(e.name, dims));
    if (factor == 1) continue;
    e.radiance *= factor;
    e.sky.ground *= factor;
  }
}

double dimming_of(const std::string& name, const std::vector<std::string>& dims) {
  double factor = 1;
  for (const std::string& text : dims) {
    const Dim d = parse_dim(text);
    if (fits_wildcard(name, d.name)) factor = d.factor;
  }
  return factor;
}

}  // namespace troffer
