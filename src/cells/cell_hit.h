// A place on a surface, seen from one side, where light from all around is asked for.
#pragma once

#include <cstdint>

#include "base/vec.h"

namespace troffer {

struct CellHit {
  Vec3 position;
  Vec3 normal;       // unit, that of the cosine: shading normal on the viewer's side
  Vec3 horizon;      // unit, geometric normal on the viewer's side
  float offset = 0;  // metres off the surface at which rays start
  // A coat over what is matte there: 2 × material, and 1 on the inside; and texture coordinates.
  uint32_t coated = uncoated;
  Vec2 uv{};

  static constexpr uint32_t uncoated = 0xffffffffu;
};

}  // namespace troffer
