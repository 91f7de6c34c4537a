// Patches as sources over the unit square.
#include <doctest/doctest.h>

#include <cmath>

#include "base/random.h"
#include "radiosity/patch_surface.h"
#include "radiosity/rooms.h"
#include "support/light_scenes.h"

using namespace troffer;
using namespace troffer::test;

TEST_CASE("patch surfaces have the patches' area, side, and place") {
  Scene s = lit_room(0.5f);
  const uint32_t grey = add_diffuse(s, Rgb{0.4f});
  add_sphere_light(s, grey, {1, 1, 0.8f}, 0.3f, Rgb{1});
  Mesh bent;  // joined, but not a convex polygon
  bent.material = grey;
  bent.positions = {{3, 1, 1},    {3.3f, 1, 1},     {3.3f, 1.3f, 1},
                    {3, 1.3f, 1}, {3.6f, 1, 1.01f}, {3.3f, 1.6f, 1}};
  bent.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 2}, {3, 2, 5}};
  s.meshes.push_back(bent);
  const Ready ready(std::move(s));
  const RadiosityMesh mesh = ready.mesh(sizes(0.5f, 1.5f));
  Random random(1);
  uint32_t parallelograms = 0, backs = 0, many = 0, round = 0;
  for (uint32_t i = 0; i < mesh.patches.size(); ++i) {
    const Patch& patch = mesh.patches[i];
    const Sheet& sheet = mesh.sheets[patch.sheet];
    const SourceSurface surface = patch_surface(mesh, i);
    const bool is_round = sheet.round_radius > 0;
    CHECK(surface.area() == doctest::Approx(double(patch.area)).epsilon(is_round ? 0.3 : 1e-4));
    parallelograms += surface.is_parallelogram();
    backs += patch.is_back;
    many += sheet.last_piece - sheet.first_piece > 1;
    round += is_round;
    if (is_round) CHECK_FALSE(patch.is_back);  // no light inside
    const ElementPoint& p = mesh.points[patch.first_point];
    for (int k = 0; k < 20; ++k) {
      const SourcePoint at = surface.point_at(random.next_vec2());
      CHECK(dot(at.normal, p.normal) > (is_round ? 0.0f : 0.99f));
      const Vec3 target = ray_target(mesh, i, at);
      if (is_round)
        CHECK(length(target - sheet.round_centre) ==
              doctest::Approx(sheet.round_radius + sheet.offset).epsilon(1e-5));
      else
        CHECK(dot(target - p.position, p.normal) >
              (sheet.last_piece - sheet.first_piece > 1 ? -0.02f : 0.0f));
      // Nothing occludes the target from a point just in front of it.
      Ray ray;
      ray.origin = target + (is_round ? normalize(target - sheet.round_centre) : at.normal) * 0.01f;
      ray.direction = target - ray.origin;
      ray.t_max = 1;
      uint8_t is_occluded = 1;
      ready.tracer.occluded({&ray, 1}, {&is_occluded, 1});
      CHECK(is_occluded == 0);
    }
  }
  CHECK(parallelograms > 0);
  CHECK(backs > 0);
  CHECK(many > 0);
  CHECK(round > 0);
}
