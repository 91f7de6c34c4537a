// A small bright region that few gather rays meet: the number of rays of a pixel must not depend on
// its own samples.
#include <doctest/doctest.h>

#include "render/pictures.h"
#include "support/scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// A kitchen with matte cupboards, dark below and light above, lit by a strip above the worktop. The
// floor gets most of its reflected light from there.
Scene kitchen() {
  Scene s;
  add_quad(s, add_diffuse(s, Rgb{0.32f}), {Vec3{0, 0, 0}, {4, 0, 0}, {4, 5, 0}, {0, 5, 0}});
  add_box_inside(s, add_diffuse(s, Rgb{0.8f}), {0, 0, 0.0001f}, {4, 5, 2.8f});
  add_box_inside(s, add_diffuse(s, Rgb{0.25f}), {0.6f, 4.4f, 0.1f}, {3.6f, 5, 0.85f});
  add_box_inside(s, add_diffuse(s, Rgb{0.1f}), {0.6f, 4.35f, 0.86f}, {3.6f, 5, 0.9f});
  add_box_inside(s, add_diffuse(s, Rgb{0.75f}), {0.6f, 4.62f, 1.45f}, {3.6f, 5, 2.1f});
  add_quad(s, add_diffuse(s, Rgb{0.9f}),
           {Vec3{0.6f, 4.995f, 0.9f},
            {0.6f, 4.995f, 1.45f},
            {3.6f, 4.995f, 1.45f},
            {3.6f, 4.995f, 0.9f}});
  make_light(s,
             add_quad(s, add_diffuse(s, Rgb{0}),
                      {Vec3{0.7f, 4.7f, 1.44f},
                       {0.7f, 4.74f, 1.44f},
                       {3.5f, 4.74f, 1.44f},
                       {3.5f, 4.7f, 1.44f}}),
             Rgb{55});
  return s;
}

}  // namespace

TEST_CASE("a floor lit by reflection off a worktop gets all of that light") {
  const PreparedScene scene(kitchen());
  const Camera camera = look_at({0.5f, 0.5f, 1.5f}, {3.2f, 4.2f, 0.9f}, {0, 0, 1}, 75);
  RenderOptions path;
  path.has_crop = true;
  path.crop = {0, 36, 56, 48};
  RenderOptions ours = path;
  path.method = Method::path;
  path.spp = path.max_spp = 4096;
  const double right = mean(reflected_light(scene, camera, 64, 48, path));
  ours.error = 0.05;
  double made = 0;
  constexpr int pictures = 8;
  for (uint64_t seed = 0; seed < pictures; ++seed) {
    ours.seed = seed;
    made += mean(reflected_light(scene, camera, 64, 48, ours)) / pictures;
  }
  // -.0104 if pixels decide by their own samples, -.0051 if by others'.
  MESSAGE("reflected light off by ", made / right - 1);
  CHECK(made / right == doctest::Approx(1).epsilon(0.0085));
}
