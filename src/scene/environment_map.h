// Image of the light from infinity, over all directions: plain data. Evaluated and sampled by
// light/environment_image.h.
#pragma once

#include <string>
#include <vector>

#include "base/rgb.h"
#include "base/sphere_map.h"

namespace troffer {

struct EnvironmentMap {
  std::string name;
  SphereMap projection = SphereMap::lat_long;
  int width = 0, height = 0;  // at least 1; equal for equal_area
  // Radiance in W/(m² sr), or cd/m² if Scene::is_photometric. Row-major, row 0 at v = 0; finite,
  // not negative.
  std::vector<Rgb> texels;
};

}  // namespace troffer
