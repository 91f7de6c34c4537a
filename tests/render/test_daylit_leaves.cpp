// Leaves in the open: much light arrives, and there is little to prove.
#include <doctest/doctest.h>

#include <cmath>

#include "base/random.h"
#include "pictures.h"
#include "support/light_scenes.h"
#include "support/surfaceless_lights.h"

using namespace troffer;
using namespace troffer::test;

namespace {

enum class With { sky, sky_and_sun };

PreparedScene leaves(With with, bool is_wall = false) {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  add_quad(s, grey, {Vec3{-20, -20, 0}, {20, -20, 0}, {20, 20, 0}, {-20, 20, 0}});
  Random random(3);
  const auto any = [&] { return 2 * random.next_float() - 1; };
  for (int i = 0; i < (is_wall ? 0 : 3000); ++i) {
    const Vec3 c{3 * any(), 3 * any(), 2.5f + any()};
    const Vec3 a = normalize(Vec3{any(), any(), any()}) * 0.12f;
    const Vec3 b = normalize(Vec3{any(), any(), any()}) * 0.12f;
    Mesh m;
    m.positions = {c + a, c + b, c - a};
    m.triangles = {{0, 1, 2}};
    m.material = grey;
    s.meshes.push_back(std::move(m));
  }
  if (is_wall) add_box_inside(s, grey, {-4, 3, 0}, {4, 3.2f, 3});
  add_environment(s, Rgb{2});
  if (with == With::sky_and_sun) {
    Light& sun = add_light(s, LightKind::sun, Rgb{4e5f});
    sun.direction = normalize(Vec3{-1, 0.2f, -0.9f});
    sun.angular_radius = 0.00465f;
  }
  return PreparedScene(std::move(s));
}

RenderResult picture(const PreparedScene& scene, Method method, int threads = 2) {
  RenderOptions o;
  o.width = 32;
  o.height = 24;
  o.method = method;
  o.indirect = Indirect::none;
  o.threads = threads;
  if (method == Method::fixed) {
    o.spp = 16;
    o.shadow_rays = 64;
  }
  return render_now(scene, look_at({0, -7, 1.7f}, {0, 0, 1}, {0, 0, 1}, 60), o);
}

}  // namespace

TEST_CASE("behind leaves no proofs are asked for; behind a wall they are") {
  const Counters open = picture(leaves(With::sky), Method::certified).statistics.counters;
  CHECK(open.masked + open.lit_certified < open.mixed / 10);
  const Counters wall = picture(leaves(With::sky, true), Method::certified).statistics.counters;
  CHECK(wall.masked + wall.lit_certified > wall.mixed);
}

TEST_CASE("where the sun shines the sky gets fewer rays") {
  const Counters shade = picture(leaves(With::sky), Method::certified).statistics.counters;
  const Counters sunny = picture(leaves(With::sky_and_sun), Method::certified).statistics.counters;
  CHECK(double(sunny.shadow_rays) < 0.9 * double(shade.shadow_rays));
}

TEST_CASE("leaves under sky and sun are as bright as by fixed rays, on one thread and on two") {
  const PreparedScene scene = leaves(With::sky_and_sun);
  const RenderResult a = picture(scene, Method::certified), b = picture(scene, Method::fixed),
                     one = picture(scene, Method::certified, 1);
  CHECK(mean_green(a.layers[0].image) ==
        doctest::Approx(mean_green(b.layers[0].image)).epsilon(0.01));
  CHECK(is_identical(a.layers, one.layers));
}
