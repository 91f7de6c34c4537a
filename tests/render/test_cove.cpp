// Light that comes from behind a lip: what a ray sees of the surfaces there depends on where it
// comes from.
#include <doctest/doctest.h>

#include "render/pictures.h"
#include "support/scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// A room lit by a strip in a trough along one wall, with a slit of 3 cm below the ceiling.
Scene cove_room() {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.7f});
  add_box_inside(s, grey, {0, 0, 0}, {4, 5, 2.8f});
  add_quad(s, grey, {Vec3{0, 0, 2.5f}, {0.2f, 0, 2.5f}, {0.2f, 5, 2.5f}, {0, 5, 2.5f}});
  add_quad(s, grey, {Vec3{0.2f, 0, 2.5f}, {0.2f, 5, 2.5f}, {0.2f, 5, 2.77f}, {0.2f, 0, 2.77f}});
  make_light(s,
             add_quad(s, add_diffuse(s, Rgb{0}),
                      {Vec3{0.05f, 0.1f, 2.53f},
                       {0.1f, 0.1f, 2.53f},
                       {0.1f, 4.9f, 2.53f},
                       {0.05f, 4.9f, 2.53f}}),
             Rgb{100});
  return s;
}

// Sums over the columns from x0 to x1.
double sum(const Image& image, int x0, int x1) {
  double all = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = x0; x < x1; ++x) all += double(luminance(image.at(x, y)));
  return all;
}

}  // namespace

TEST_CASE("a cove lights the far side of a room and the near one as much as by paths") {
  const PreparedScene scene(cove_room());
  const Camera camera = look_at({0.5f, 0.5f, 1.5f}, {3.2f, 4.2f, 0.9f}, {0, 0, 1}, 75);
  constexpr int width = 48, height = 36;
  RenderOptions path;
  path.method = Method::path;
  path.spp = path.max_spp = 2048;
  const Image truth = reflected_light(scene, camera, width, height, path);
  RenderOptions ours;
  ours.error = 0.05;
  for (const uint64_t seed : {1, 2}) {
    ours.seed = seed;
    const Image image = reflected_light(scene, camera, width, height, ours);
    // (−.20 and +.15 before cells were halved; paths are known to .02.)
    CHECK(sum(image, 0, 24) / sum(truth, 0, 24) == doctest::Approx(1).epsilon(0.1));
    CHECK(sum(image, 24, 48) / sum(truth, 24, 48) == doctest::Approx(1).epsilon(0.1));
  }
}
