// Pictures by paths where few paths find light: a lamp smaller than a pixel, and a lamp in a tube.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "render/pictures.h"
#include "support/light_scenes.h"
#include "support/surfaceless_lights.h"

using namespace troffer;
using namespace troffer::test;

namespace {

Scene grey_room() {
  Scene s;
  add_box_inside(s, add_diffuse(s, Rgb{0.5f}), {0, 0, 0}, {4, 4, 3});
  return s;
}

RenderOptions tiny_picture(double error) {
  RenderOptions o;
  o.indirect = Indirect::automatic;
  o.error = error;
  o.width = 24;
  o.height = 18;
  o.threads = 2;
  return o;
}

}  // namespace

TEST_CASE("paths: a lamp much smaller than its pixel is found") {
  Scene s = grey_room();
  const float radius = 0.01f, radiance = 3000;
  const Vec3 eye{0.5f, 0.5f, 1.5f}, target{3.5f, 3, 1.8f}, lamp{2.6f, 2.4f, 2};
  add_sphere_light(s, add_diffuse(s, Rgb{0}), lamp, radius, Rgb{radiance});
  const PreparedScene scene(std::move(s));
  // The shorter side of 18 pixels has 60°. A sphere beside the axis covers more than on it.
  const double focal = 9 / std::tan(pi / 6),
               depth = double(dot(lamp - eye, normalize(target - eye))),
               cosine = depth / double(length(lamp - eye)),
               covered = pi * sqr(double(radius) * focal / depth) / cosine,
               expected = covered * double(radiance);
  for (const double error : {0.3, 0.05}) {
    CAPTURE(error);
    const RenderResult r =
        render_now(scene, look_at(eye, target, {0, 0, 1}, 60), tiny_picture(error));
    CHECK(r.statistics.is_by_paths);
    double most = 0;
    for (const Rgb& pixel : r.layers[0].image.pixels)
      most = std::max(most, double(luminance(pixel)));
    // About ten of 1024 rays meet the lamp.
    CHECK(most == doctest::Approx(expected).epsilon(0.5));
  }
}

TEST_CASE("paths: rare light takes no more rays than forecast") {
  Scene s = grey_room();
  const uint32_t black = add_diffuse(s, Rgb{0.02f});
  // A tube that is open at the top, and a lamp in it that shines up.
  const float x0 = 1, x1 = 1.2f, y0 = 0.4f, y1 = 0.6f, z0 = 2, z1 = 2.6f;
  add_quad(s, black, {Vec3{x0, y0, z0}, {x1, y0, z0}, {x1, y0, z1}, {x0, y0, z1}});
  add_quad(s, black, {Vec3{x1, y0, z0}, {x1, y1, z0}, {x1, y1, z1}, {x1, y0, z1}});
  add_quad(s, black, {Vec3{x1, y1, z0}, {x0, y1, z0}, {x0, y1, z1}, {x1, y1, z1}});
  add_quad(s, black, {Vec3{x0, y1, z0}, {x0, y0, z0}, {x0, y0, z1}, {x0, y1, z1}});
  const uint32_t lamp = add_quad(s, add_diffuse(s, Rgb{0}),
                                 {Vec3{1.02f, 0.42f, 2.01f},
                                  {1.18f, 0.42f, 2.01f},
                                  {1.18f, 0.58f, 2.01f},
                                  {1.02f, 0.58f, 2.01f}});
  make_light(s, lamp, Rgb{500}, false);
  add_point(s, {2, 2, 1}, Rgb{1e-5f});
  const PreparedScene scene(std::move(s));
  const RenderOptions o = tiny_picture(1);
  const RenderResult r =
      render_now(scene, look_at({0.5f, 0.5f, 1.5f}, {3.5f, 3, 0.8f}, {0, 0, 1}, 60), o);
  REQUIRE(r.statistics.is_by_paths);
  REQUIRE(r.statistics.plan.forecast);
  const double rays = double(r.statistics.counters.viewing_rays) / (o.width * o.height);
  CHECK(rays < 2 * r.statistics.plan.forecast->viewing_rays);
}
