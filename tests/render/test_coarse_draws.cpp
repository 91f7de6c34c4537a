// Coarse pictures: viewing rays sample points of lights where certificates cost more.
#include <doctest/doctest.h>

#include "base/random.h"
#include "render/pictures.h"
#include "support/scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// Nine lamps over a thicket of 6000 leaves.
Scene thicket() {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  add_box_inside(s, grey, {0, 0, 0}, {4, 4, 3});
  for (uint32_t i = 0; i < 6000; ++i) {
    const auto at = [&](uint32_t k) { return unit_float(uint32_t(hash_of(i, k) >> 32)); };
    const Vec3 x{0.2f + 3.4f * at(0), 0.2f + 3.4f * at(1), 1.2f + 1.2f * at(2)};
    const Vec3 u{0.06f, 0.04f * at(3), 0.04f * at(4)}, v{0, 0.06f, 0.04f * at(5)};
    add_quad(s, grey, {x, x + u, x + u + v, x + v});
  }
  for (int i = 0; i < 9; ++i) {
    const float x = 0.5f + 1.2f * float(i % 3), y = 0.5f + 1.2f * float(i / 3), z = 2.99f;
    make_light(
        s,
        add_quad(s, grey,
                 {Vec3{x, y, z}, {x, y + 0.5f, z}, {x + 0.5f, y + 0.5f, z}, {x + 0.5f, y, z}}),
        Rgb{5});
  }
  return s;
}

}  // namespace

TEST_CASE("coarse pictures sample points of many lamps behind a thicket") {
  const PreparedScene scene(thicket());
  const Camera camera = look_at({0.3f, 0.3f, 1}, {2.5f, 2.5f, 0}, {0, 0, 1}, 70);
  RenderOptions o;
  o.width = 48;
  o.height = 36;
  o.threads = 2;
  o.spp = o.max_spp = 1;  // no further viewing rays, which sample points in any case
  o.indirect = Indirect::cells;
  o.error = 0.2;
  const RenderResult coarse = render_now(scene, camera, o);
  o.error = 0.199;
  const RenderResult finer = render_now(scene, camera, o);
  const auto rays = [](const RenderResult& r) {
    return double(r.statistics.counters.shadow_rays) / (48 * 36);
  };
  // 44: the samples, and the proofs attempted for a few hits of each cluster
  CHECK(rays(coarse) < 60);
  CHECK(rays(finer) > 100);  // 138
  CHECK(mean(coarse.layers[0].image) == doctest::Approx(mean(finer.layers[0].image)).epsilon(0.02));
}
