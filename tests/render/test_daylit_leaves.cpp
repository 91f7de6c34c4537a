// Leaves in the open: much light arrives, and little can be certified.
#include <doctest/doctest.h>

#include <algorithm>
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

RenderResult picture(const PreparedScene& scene, Method method, int threads = 2,
                     double error = 0.01, int max_spp = 0) {
  RenderOptions o;
  o.width = 32;
  o.height = 24;
  o.method = method;
  o.indirect = Indirect::none;
  o.threads = threads;
  o.error = error;
  o.max_spp = max_spp;
  if (method == Method::fixed) {
    o.spp = 16;
    o.shadow_rays = 64;
  }
  return render_now(scene, look_at({0, -7, 1.7f}, {0, 0, 1}, {0, 0, 1}, 60), o);
}

}  // namespace

TEST_CASE(
    "no certificates in the open, behind leaves or behind a wall, except for a small asked error") {
  for (const bool is_wall : {false, true}) {
    const Counters open =
        picture(leaves(With::sky, is_wall), Method::certified).statistics.counters;
    CHECK(open.masked + open.lit_certified < open.mixed / 10);
    CHECK(open.shadow_rays < 40 * open.viewing_rays);
  }
  const Counters small =
      picture(leaves(With::sky, true), Method::certified, 2, 0.001).statistics.counters;
  CHECK(2 * (small.masked + small.lit_certified) > small.mixed);
}

// Certificates cost far more than rays of the same error here.
TEST_CASE("a wall in the open meets the asked error, with rays as uniform as fixed ones") {
  const PreparedScene scene = leaves(With::sky, true);
  const RenderResult mine = picture(scene, Method::certified),
                     fixed = picture(scene, Method::fixed);
  const Image &a = mine.layers[0].image, &b = fixed.layers[0].image;
  std::vector<float> off;
  for (size_t i = 0; i < a.pixels.size(); ++i)
    off.push_back(std::abs(a.pixels[i].g - b.pixels[i].g) / b.pixels[i].g);
  std::nth_element(off.begin(), off.begin() + std::ptrdiff_t(off.size() / 2), off.end());
  CHECK(off[off.size() / 2] < 0.01f);
}

TEST_CASE("in sunlight the sky gets fewer rays") {
  const auto counters = [](With with) {
    return picture(leaves(with), Method::certified, 2, 0.01, 4).statistics.counters;
  };
  const Counters shade = counters(With::sky), sunny = counters(With::sky_and_sun);
  CHECK(double(sunny.shadow_rays) < 0.9 * double(shade.shadow_rays));
}

TEST_CASE("leaves under sky and sun agree with fixed rays, on one thread and on two") {
  const PreparedScene scene = leaves(With::sky_and_sun);
  const RenderResult a = picture(scene, Method::certified), b = picture(scene, Method::fixed),
                     one = picture(scene, Method::certified, 1);
  CHECK(mean_green(a.layers[0].image) ==
        doctest::Approx(mean_green(b.layers[0].image)).epsilon(0.01));
  CHECK(is_identical(a.layers, one.layers));
}
