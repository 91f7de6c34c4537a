// Light that is reflected many times between metals before it meets a matte surface.
#include <doctest/doctest.h>

#include "render/pictures.h"
#include "support/scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// Walls of rough white metal around a grey table top.
Scene metal_room(float reflectance, float alpha) {
  Scene s;
  Material m;
  m.kind = MaterialKind::conductor;
  m.is_reflectance = true;
  m.base_color.value = Rgb{reflectance};
  m.roughness.value = alpha;
  add_box_inside(s, add_material(s, m), {-1.5f, -1.5f, 0}, {1.5f, 1.5f, 3});
  add_quad(
      s, add_diffuse(s, Rgb{0.5f}),
      {Vec3{-0.3f, -0.3f, 0.7f}, {0.9f, -0.3f, 0.7f}, {0.9f, 0.9f, 0.7f}, {-0.3f, 0.9f, 0.7f}});
  add_ceiling_light(s, 0.5f, 2.99f, Rgb{10});
  return s;
}

}  // namespace

TEST_CASE("no light is lost between white metals, however often it is reflected") {
  for (const float alpha : {0.1f, 0.4f}) {
    CAPTURE(alpha);
    const PreparedScene scene(metal_room(0.97f, alpha));
    const Camera camera = look_at({-1, -1, 1.5f}, {1, 1, 0.5f}, {0, 0, 1}, 70);
    RenderOptions path;
    path.method = Method::path;
    path.spp = 512;
    RenderOptions ours;
    ours.error = 0.02;
    const double truth = mean(reflected_light(scene, camera, 24, 18, path));
    CHECK(mean(reflected_light(scene, camera, 24, 18, ours)) / truth ==
          doctest::Approx(1).epsilon(0.007));
  }
}
