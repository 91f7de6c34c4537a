#include "render/source_info.h"

#include "emitter/light_primitive.h"

namespace troffer {

std::vector<SourceInfo> source_infos(const Scene& scene) {
  std::vector<SourceInfo> infos(scene.emitters.size());
  const LightPrimitives primitives(scene);
  for (const LightPrimitive& p : primitives.all()) {
    infos[p.emitter].area += double(p.area);
    infos[p.emitter].power += double(p.power);
  }
  return infos;
}

}  // namespace troffer
