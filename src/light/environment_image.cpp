#include "light/environment_image.h"

#include "scene/environment_lookup.h"

namespace troffer {

Rgb radiance_towards(const EnvironmentMap& map, const Vec3& w) {
  return value_at(map, square_from_direction(map.projection, w));
}

DirectionTable direction_table(const EnvironmentMap& map) {
  std::vector<float> luminances(map.texels.size());
  for (size_t i = 0; i < luminances.size(); ++i) luminances[i] = luminance(map.texels[i]);
  return {map.projection, map.width, map.height, luminances};
}

}  // namespace troffer
