// Interreflection between coated walls. The light that a coat transmits depends on the direction of
// incidence as much as on that of reflection.
#include <doctest/doctest.h>

#include "render/pictures.h"
#include "support/scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// Light of a small source reaches the floor at right angles, where a coat transmits most.
Scene coated_room(float alpha) {
  Scene s;
  Material m;
  m.kind = MaterialKind::coated_diffuse;
  m.base_color.value = Rgb{0.6f};
  m.roughness.value = alpha;
  add_box_inside(s, add_material(s, m), {-1.5f, -1.5f, 0}, {1.5f, 1.5f, 3});
  add_ceiling_light(s, 0.6f, 2.99f, Rgb{10});
  return s;
}

double reflected(const PreparedScene& scene, const RenderOptions& o) {
  const Camera camera = look_at({-0.5f, -0.5f, 1.5f}, {1, 1, 1}, {0, 0, 1}, 70);
  return mean(reflected_light(scene, camera, 48, 36, o));
}

}  // namespace

TEST_CASE("no light is lost between coated walls") {
  for (const float alpha : {0.25f, 0.5f}) {
    CAPTURE(alpha);
    const PreparedScene scene(coated_room(alpha));
    RenderOptions path;
    path.method = Method::path;
    path.spp = 512;
    RenderOptions ours;
    ours.error = 0.02;
    CHECK(reflected(scene, ours) / reflected(scene, path) == doctest::Approx(1).epsilon(0.004));
  }
}
