// Caustics: light from glass and curved mirrors on matte surfaces, by cells and by paths.
#include <doctest/doctest.h>

#include <cmath>

#include "base/units.h"
#include "render/pictures.h"

using namespace troffer;
using namespace troffer::test;

namespace {

Material clear_glass() {
  Material m;
  m.kind = MaterialKind::dielectric;
  m.base_color.value = Rgb{1};
  return m;
}
Material mirror() {
  Material m;
  m.kind = MaterialKind::conductor;
  m.is_reflectance = true;
  m.base_color.value = Rgb{0.95f};
  return m;
}

// A light of 25 cm over a dark floor in a dark room. Apart from direct light, nearly all light of
// the floor is the caustic.
Scene dark_room() {
  Scene s;
  add_box_inside(s, add_diffuse(s, Rgb{0.1f}), {-2, -2, 0}, {2, 2, 2.5f});
  add_ceiling_light(s, 0.25f, 2.4f, Rgb{100});
  return s;
}

// With `spp` paths per pixel, the standard error of the difference is below a quarter of the bound.
void check_same_light(const PreparedScene& scene, const Camera& camera, int spp) {
  RenderOptions o;
  o.width = 64;
  o.height = 48;
  o.threads = 2;
  o.error = 0.05;
  const Ensemble mine = render_ensemble(scene, camera, o, 5);
  o.method = Method::path;
  o.spp = o.max_spp = spp;
  const Ensemble paths = render_ensemble(scene, camera, o, 4);
  CAPTURE(mine.mean.standard_error() / mine.mean.mean());
  CAPTURE(paths.mean.standard_error() / paths.mean.mean());
  CHECK(mine.mean.mean() == doctest::Approx(paths.mean.mean()).epsilon(0.05));
}

}  // namespace

TEST_CASE("caustics: light below a glass ball agrees with paths") {
  Scene s = dark_room();
  s.spheres.push_back({{0, 0, 0.6f}, 0.35f, false, add_material(s, clear_glass()), no_light});
  const PreparedScene scene(std::move(s));
  check_same_light(scene, look_at({0.9f, -0.9f, 0.5f}, {0, 0, 0}, {0, 0, 1}, 40), 512);
}

TEST_CASE("caustics: light in front of a curved mirror agrees with paths") {
  Scene s = dark_room();
  const uint32_t material = add_material(s, mirror());
  // A hollow half cylinder next to the place below the light.
  constexpr int sides = 24;
  for (int i = 0; i < sides; ++i) {
    const auto at = [](int k) {
      const float a = float(pi) * float(k) / sides;
      return Vec3{0.5f * std::cos(a), 0.3f + 0.5f * std::sin(a), 0};
    };
    const Vec3 a = at(i), b = at(i + 1), up{0, 0, 0.8f};
    add_quad(s, material, {a, b, b + up, a + up});
  }
  const PreparedScene scene(std::move(s));
  check_same_light(scene, look_at({0.4f, -1.2f, 1.2f}, {0, 0.35f, 0}, {0, 0, 1}, 40), 128);
}
