// Measuring points under many lamps, whose light is estimated with sampled points on the lamps.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "render/measure.h"
#include "support/scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace {

const StopFlag runs_on = false;

// 80 lamps from a centimetre to half a metre wide over boxes, each of which hides few lamps.
Scene lamps_over_clutter() {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  Random random(3);
  const auto between = [&](float low, float high) {
    return low + (high - low) * random.next_float();
  };
  add_quad(s, grey, {Vec3{0, 0, 0}, {8, 0, 0}, {8, 6, 0}, {0, 6, 0}});
  for (int i = 0; i < 80; ++i) {
    const float w = std::pow(10.0f, between(-2.3f, -0.6f)), h = w * between(0.2f, 1);
    const float x = between(0.5f, 7.5f), y = between(0.5f, 5.5f), z = between(1.6f, 2.95f);
    const uint32_t lamp = add_quad(
        s, grey, {Vec3{x - w, y - h, z}, {x - w, y + h, z}, {x + w, y + h, z}, {x + w, y - h, z}});
    make_light(s, lamp, Rgb{between(0.02f, 0.2f) / (w * w)});
  }
  for (int i = 0; i < 300; ++i) {
    const Vec3 a{between(0.1f, 7.5f), between(0.1f, 5.5f), between(0, 1.2f)};
    add_box_inside(s, grey, a, a + Vec3{between(0.03f, 0.3f), between(0.03f, 0.3f), 0.2f});
  }
  return s;
}

}  // namespace

TEST_CASE(
    "the estimated error of points under many lamps is right even if few samples find a hidden "
    "lamp") {
  const PreparedScene scene(lamps_over_clutter());
  Random random(7);
  std::vector<MeasuringPoint> points(30);
  for (MeasuringPoint& p : points) {
    p.position = {0.2 + 7.6 * random.next_double(), 0.2 + 5.6 * random.next_double(),
                  1.1 + 0.3 * random.next_double()};
    p.normal = {0, 0, 1};
  }
  MeasureOptions o;
  o.indirect = Indirect::none;
  o.threads = 2;
  MeasureOptions paths = o;
  paths.method = Method::path;
  paths.depth = 1;
  paths.spp = 1 << 17;
  const MeasureResult truth = measure(scene, points, paths, {}, runs_on);
  double squares = 0, most = 0;
  int n = 0;
  for (uint64_t seed = 0; seed < 8; ++seed) {
    o.seed = seed;
    const MeasureResult found = measure(scene, points, o, {}, runs_on);
    for (size_t i = 0; i < points.size(); ++i) {
      const Measurement &a = found.values[i], &b = truth.values[i];
      if (!(b.illuminance_lx > 0)) continue;
      const double z =
          (a.illuminance_lx - b.illuminance_lx) / std::hypot(a.standard_error, b.standard_error);
      squares += z * z;
      most = std::max(most, std::abs(z));
      ++n;
    }
  }
  REQUIRE(n > 200);
  CHECK(std::sqrt(squares / n) < 1.2);
  CHECK(most < 4.5);
}
