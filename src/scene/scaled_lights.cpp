#include "scene/scaled_lights.h"

#include "base/error.h"

namespace troffer {

Scene with_scaled_lights(Scene scene, std::span<const Rgb> factors) {
  TROFFER_CHECK(factors.size() == scene.lights.size());
  for (size_t i = 0; i < factors.size(); ++i) {
    Light& light = scene.lights[i];
    light.radiance = light.radiance * factors[i];
    // A sky's ground has a radiance of its own, which `radiance` does not scale.
    light.sky.ground = light.sky.ground * factors[i];
  }
  return scene;
}

}  // namespace troffer
