// A place on one side of a surface where light from all around is asked for. Shared by cells,
// gather rays, records and sensors.
#pragma once

#include <cstdint>

#include "base/vec.h"

namespace troffer {

struct CellHit {
  Vec3 position;
  Vec3 normal;       // unit, of the cosine: shading normal on the viewer's side
  Vec3 horizon;      // unit, geometric normal on the viewer's side
  float offset = 0;  // metres off the surface at which rays start
  // Coat over the matte layer: 2 × material, plus 1 on the inside. `uv` are its texture
  // coordinates.
  uint32_t coated = uncoated;
  Vec2 uv{};

  static constexpr uint32_t uncoated = 0xffffffffu;
};

}  // namespace troffer
