// A small office to assess, 4 × 5 × 2.8 m, z up: a desk with a keyboard, a shelf, a cabinet, two
// panels. Tests of assessments and of searches use it.
#pragma once

#include "support/scenes.h"

namespace troffer::test {

// Adds a closed box [a, b] with its front outward.
inline void add_body(Scene& s, uint32_t material, const Vec3& a, const Vec3& b,
                     const std::string& name) {
  const auto first = s.meshes.size();
  add_box_inside(s, material, a, b);
  Mesh body;
  body.name = name;
  body.material = material;
  for (size_t m = first; m < s.meshes.size(); ++m) {
    const auto base = uint32_t(body.positions.size());
    for (const Vec3& p : s.meshes[m].positions) body.positions.push_back(p);
    for (const Triangle& t : s.meshes[m].triangles)
      body.triangles.push_back({base + t[0], base + t[2], base + t[1]});
  }
  s.meshes.resize(first);
  s.meshes.push_back(std::move(body));
}

inline void add_panel(Scene& s, const std::string& name, float x, float y, float side, float height,
                      Rgb radiance) {
  const uint32_t black = add_diffuse(s, Rgb{0});
  const float r = side / 2;
  make_light(s,
             add_quad(s, black,
                      {Vec3{x - r, y - r, height},
                       {x - r, y + r, height},
                       {x + r, y + r, height},
                       {x + r, y - r, height}}),
             radiance);
  s.lights.back().name = name;
}

inline Scene small_office(Rgb walls = Rgb{0.5f}) {
  Scene s;
  s.is_photometric = true;
  const uint32_t grey = add_diffuse(s, walls);
  for (const uint32_t m : add_box_inside(s, grey, {0, 0, 0}, {4, 5, 2.8f}))
    s.meshes[m].name = "wall";
  s.meshes[0].name = "floor";
  add_body(s, grey, {1, 1.5f, 0.7f}, {2.6f, 2.3f, 0.74f}, "desk");
  add_body(s, grey, {1.2f, 1.6f, 0.74f}, {1.6f, 1.9f, 0.76f}, "keyboard");
  add_body(s, grey, {2.9f, 0.1f, 0}, {3.9f, 1.7f, 1.1f}, "cabinet");
  add_body(s, grey, {0.1f, 4, 0.8f}, {1.3f, 4.4f, 0.82f}, "shelf");
  add_body(s, grey, {0.1f, 4, 1.1f}, {1.3f, 4.4f, 1.12f}, "shelf");
  add_panel(s, "left", 1, 2.5f, 0.6f, 2.79f, Rgb{6000});
  add_panel(s, "right", 3, 2.5f, 0.6f, 2.79f, Rgb{3000});
  return s;
}

}  // namespace troffer::test
