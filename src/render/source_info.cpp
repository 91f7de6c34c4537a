#include "render/source_info.h"

#include "light/light_primitive.h"

namespace troffer {

std::vector<SourceInfo> source_infos(const Scene& scene) {
  std::vector<SourceInfo> infos(scene.lights.size());
  const LightPrimitives primitives(scene);
  for (const LightPrimitive& p : primitives.all()) {
    infos[p.light].area += double(p.area);
    infos[p.light].power += double(p.power);
  }
  return infos;
}

}  // namespace troffer
