// A furnace: a closed room in which radiance is the same everywhere, whatever stands in it.
#pragma once

#include "render/camera.h"
#include "render/render.h"
#include "support/light_scenes.h"
#include "support/scenes.h"

namespace troffer::test {

inline constexpr float L0 = 3;

// Surfaces of many reflectances rho, each emitting (1 - rho) L0, so that radiance is L0 everywhere.
inline Scene uneven_furnace() {
  Scene s;
  const auto grey = [&](float rho) { return add_diffuse(s, Rgb{rho}); };
  const auto glow = [](float rho) { return Rgb{(1 - rho) * L0}; };
  const auto walls = add_box_inside(s, grey(0), {-2, -2, 0}, {2, 2, 2.5f});
  const float reflectances[] = {0.2f, 0.9f, 0.5f, 0.0f, 0.7f, 0.35f};
  for (size_t i = 0; i < 6; ++i) {
    s.meshes[walls[i]].material = grey(reflectances[i]);
    make_light(s, walls[i], glow(reflectances[i]));
  }
  // Objects that shade one another: a block that reflects everything, a ball, a disk, a screen.
  const auto block = add_box_inside(s, grey(1), {0.3f, 0.2f, 0.1f}, {1, 1, 1.2f});
  for (const uint32_t q : block)
    for (Triangle& t : s.meshes[q].triangles) std::swap(t[1], t[2]);
  add_sphere_light(s, grey(0.6f), {-0.7f, 0.6f, 0.8f}, 0.5f, glow(0.6f));
  add_disk_light(s, grey(0.8f), {-0.5f, -0.4f, 1.6f}, normalize(Vec3{1, 1, 3}), 0.6f, glow(0.8f),
                 true);
  make_light(s,
             add_quad(s, grey(0.4f),
                      {Vec3{0.2f, -1, 0.2f}, {1.2f, -0.8f, 0.2f}, {1.2f, -0.8f, 1}, {0.2f, -1, 1}}),
             glow(0.4f), true);
  add_mesh_light(s, grey(0.3f), {{-1.5f, 1, 0.3f}, {-1, 1.5f, 0.3f}, {-1.2f, 1.2f, 1.5f}},
                 {{0, 1, 2}}, glow(0.3f), true);
  return s;
}

inline Camera furnace_camera() {
  return look_at({-1.5f, -1.8f, 1.3f}, {0.2f, 0.6f, 0.8f}, {0, 0, 1}, 75);
}

// Small path-traced pictures. Means over several seeds show small energy errors.
inline RenderOptions furnace_options() {
  RenderOptions o;
  o.method = Method::path;
  o.width = 32;
  o.height = 24;
  o.spp = 16;
  return o;
}

}  // namespace troffer::test
