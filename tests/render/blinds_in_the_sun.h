// A room behind blinds in the sun.
#pragma once

#include <vector>

#include "base/random.h"
#include "render/measure.h"
#include "render/window_room.h"
#include "support/surfaceless_lights.h"

namespace troffer::test {

// The sun is high, and the slats of 25 mm are narrower than a cell. Their outer parts are sunlit; a
// higher viewpoint sees less of these.
inline Scene blinds_in_the_sun() {
  Scene s = WindowRoom::make(0.5f);
  const uint32_t white = add_diffuse(s, Rgb{0.8f});
  const float x = WindowRoom::X, y0 = WindowRoom::y0, y1 = WindowRoom::y1;
  for (int i = 0; i < 48; ++i) {
    const float z = WindowRoom::z0 + 0.025f * float(i);
    add_quad(s, white, {Vec3{x - 0.025f, y0, z}, {x, y0, z}, {x, y1, z}, {x - 0.025f, y1, z}});
  }
  add_distant(s, {-0.5f, 0.1f, -0.75f}, Rgb{100});
  return s;
}

// Points that face the blinds and see them from above; the sun is behind the blinds.
inline std::vector<MeasuringPoint> points_above(int n) {
  std::vector<MeasuringPoint> points;
  Random random(7);
  for (int i = 0; i < n; ++i) {
    MeasuringPoint& p = points.emplace_back();
    p.position = {4.2 + 0.6 * random.next_double(), 1.2 + 1.6 * random.next_double(), 2.4};
    p.normal = {0.5f, 0.4f * random.next_float() - 0.2f, -0.8f};
  }
  return points;
}

}  // namespace troffer::test
