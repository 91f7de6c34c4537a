// A room with walls of no thickness and a window in its wall at x = 5.
#pragma once

#include <vector>

#include "render/measure.h"
#include "support/light_scenes.h"

namespace troffer::test {

// 5 × 4 × 2.7 m; the window is 2 × 1.2 m.
struct WindowRoom {
  static constexpr float X = 5, Y = 4, Z = 2.7f, y0 = 1, y1 = 3, z0 = 0.9f, z1 = 2.1f;

  static Scene make(float albedo, bool has_window = true) {
    Scene s;
    const uint32_t m = add_diffuse(s, Rgb{albedo});
    add_quad(s, m, {Vec3{0, 0, 0}, {X, 0, 0}, {X, Y, 0}, {0, Y, 0}});
    add_quad(s, m, {Vec3{0, 0, Z}, {0, Y, Z}, {X, Y, Z}, {X, 0, Z}});
    add_quad(s, m, {Vec3{0, 0, 0}, {0, Y, 0}, {0, Y, Z}, {0, 0, Z}});
    add_quad(s, m, {Vec3{0, 0, 0}, {0, 0, Z}, {X, 0, Z}, {X, 0, 0}});
    add_quad(s, m, {Vec3{0, Y, 0}, {X, Y, 0}, {X, Y, Z}, {0, Y, Z}});
    add_quad(s, m, {Vec3{X, 0, 0}, {X, 0, Z}, {X, y0, Z}, {X, y0, 0}});
    add_quad(s, m, {Vec3{X, y1, 0}, {X, y1, Z}, {X, Y, Z}, {X, Y, 0}});
    add_quad(s, m, {Vec3{X, y0, 0}, {X, y0, z0}, {X, y1, z0}, {X, y1, 0}});
    add_quad(s, m, {Vec3{X, y0, z1}, {X, y0, Z}, {X, y1, Z}, {X, y1, z1}});
    if (!has_window) add_quad(s, m, {Vec3{X, y0, z0}, {X, y0, z1}, {X, y1, z1}, {X, y1, z0}});
    return s;
  }

  // Points all over the room, .2 m above its floor.
  static std::vector<MeasuringPoint> points() {
    std::vector<MeasuringPoint> points;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 3; ++j)
        points.push_back({{0.7f + 1.1f * float(i), 0.6f + 1.3f * float(j), 0.2f}, {0, 0, 1}});
    return points;
  }
};

}  // namespace troffer::test
