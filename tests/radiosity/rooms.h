// Rooms and solvers for the radiosity tests.
#pragma once

#include <utility>
#include <vector>

#include "radiosity/solver.h"
#include "support/scenes.h"

namespace troffer::test {

// A scene with everything that solve_radiosity needs. It cannot be moved.
struct Ready {
  explicit Ready(Scene s) : scene(std::move(s)), tracer(scene), tables(scene), lights(scene) {}
  Ready(const Ready&) = delete;
  Ready& operator=(const Ready&) = delete;

  RadiosityMesh mesh(const MeshingOptions& o = {}, int threads = 2) const {
    return mesh_for_radiosity(scene, tracer, tables, o, threads);
  }
  RadiositySolution solve(const RadiosityOptions& o = {}, int threads = 2) const {
    const StopFlag never = false;
    return solve_radiosity(scene, tracer, tables, lights, o, threads, {}, never);
  }

  const Scene scene;
  const Tracer tracer;
  const BsdfTables tables;
  const LightPrimitives lights;
};

inline MeshingOptions sizes(float element, float patch) {
  MeshingOptions o;
  o.element_size = element;
  o.patch_size = patch;
  return o;
}

// Adds a box whose walls emit `radiance` × (1 - reflectance).
inline void add_furnace_box(Scene& s, const Vec3& a, const Vec3& b, const float (&rho)[6],
                            float radiance) {
  const auto quads = add_box_inside(s, add_diffuse(s, Rgb{0.5f}), a, b);
  for (size_t i = 0; i < 6; ++i) {
    s.meshes[quads[i]].material = add_diffuse(s, Rgb{rho[i]});
    make_light(s, quads[i], Rgb{radiance * (1 - rho[i])});
  }
}

// Adds six outward-facing quads that emit in the same way.
inline void add_furnace_block(Scene& s, const Vec3& a, const Vec3& b, float rho, float radiance) {
  for (const uint32_t q : add_box_inside(s, add_diffuse(s, Rgb{rho}), a, b)) {
    std::swap(s.meshes[q].positions[1], s.meshes[q].positions[3]);
    make_light(s, q, Rgb{radiance * (1 - rho)});
  }
}

// Returns a w × h × d room of one reflectance, lit by a square source under the ceiling.
inline Scene lit_room(float rho, float w = 4, float h = 3, float d = 2.5f) {
  Scene s;
  add_box_inside(s, add_diffuse(s, Rgb{rho}), {0, 0, 0}, {w, h, d});
  const uint32_t q =
      add_quad(s, add_diffuse(s, Rgb{0}),
               {Vec3{1.5f, 1, 2.4f}, {1.5f, 2, 2.4f}, {2.5f, 2, 2.4f}, {2.5f, 1, 2.4f}});
  make_light(s, q, Rgb{10});
  return s;
}

}  // namespace troffer::test
