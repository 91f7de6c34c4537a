// Indirect light of surfaces with an object close in front: panels below a ceiling.
#include <doctest/doctest.h>

#include <cmath>

#include "render/pictures.h"
#include "support/scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// A hundred emitting panels with black surfaces, in rows at this distance below the ceiling.
Scene room_under_panels(float gap) {
  constexpr int side = 10;
  constexpr float half = 0.3f, height = 3;
  Scene s;
  add_box_inside(s, add_diffuse(s, Rgb{0.6f}), {0, 0, 0}, {side, side, height});
  const uint32_t black = add_diffuse(s, Rgb{0});
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const float x = float(i) + 0.5f, y = float(j) + 0.5f, z = height - gap;
      make_light(s,
                 add_quad(s, black,
                          {Vec3{x - half, y - half, z},
                           {x - half, y + half, z},
                           {x + half, y + half, z},
                           {x + half, y - half, z}}),
                 Rgb{10});
    }
  return s;
}

Image reflected(const PreparedScene& scene, const RenderOptions& o) {
  const Camera camera = look_at({1, 1, 1.5f}, {9, 9, 1.8f}, {0, 0, 1}, 70);
  return reflected_light(scene, camera, 64, 48, o);
}

}  // namespace

TEST_CASE("a ceiling close above black panels shows the light that enters between them") {
  for (const float gap : {0.01f, 0.05f}) {
    CAPTURE(gap);
    const PreparedScene scene(room_under_panels(gap));
    RenderOptions path;
    path.method = Method::path;
    path.spp = 128;
    RenderOptions ours;
    ours.error = 0.02;
    const Image right = reflected(scene, path), made = reflected(scene, ours);
    double squares = 0;  // noise of both; .055 is that of `path`
    for (size_t i = 0; i < right.pixels.size(); ++i)
      squares += std::pow(double(made.pixels[i].g) - double(right.pixels[i].g), 2);
    const double typical = mean(right);
    CHECK(mean(made) / typical == doctest::Approx(1).epsilon(0.008));
    CHECK(std::sqrt(squares / double(right.pixels.size())) < 0.07 * typical);
  }
}
