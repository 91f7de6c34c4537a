// Curtains, lampshades and opal panes: surfaces that transmit light diffusely.
#include <doctest/doctest.h>

#include <cmath>

#include "render/measure.h"
#include "render/pictures.h"
#include "support/light_scenes.h"
#include "support/surfaceless_lights.h"

using namespace troffer;
using namespace troffer::test;

namespace {

uint32_t add_paper(Scene& s, Rgb back, Rgb through) {
  Material m;
  m.kind = MaterialKind::diffuse;
  m.base_color.value = back;
  m.diffuse_transmission.value = 1;
  m.diffuse_transmission_color.value = through;
  return add_material(s, m);
}

// glTF's model, under its coat.
uint32_t add_coated_shade(Scene& s, Rgb color, float passing) {
  Material m;
  m.kind = MaterialKind::metallic_roughness;
  m.base_color.value = m.diffuse_transmission_color.value = color;
  m.metallic.value = 0;
  m.roughness.value = 0.5f;
  m.diffuse_transmission.value = passing;
  return add_material(s, m);
}

uint32_t add_screen(Scene& s, uint32_t material, float x) {
  return add_quad(s, material, {Vec3{x, -1, 0}, {x, 1, 0}, {x, 1, 2}, {x, -1, 2}});
}

// Nothing absorbs, and incident light is uniform, so everything has the same radiance.
Scene white_screens() {
  Scene s;
  add_screen(s, add_paper(s, Rgb{0.3f}, Rgb{0.7f}), 0.5f);
  add_screen(s, add_paper(s, Rgb{0}, Rgb{1}), 0.9f);
  add_screen(s, add_coated_shade(s, Rgb{1}, 0.6f), -0.4f);
  add_quad(s, add_diffuse(s, Rgb{1}), {Vec3{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}});
  add_environment(s, Rgb{2});
  return s;
}

Camera screens_camera() {
  return look_at({-2.5f, -2, 1.8f}, {0.3f, 0, 0.7f}, {0, 0, 1}, 50);
}

// A room divided by a curtain: the light is on one side, the camera on the other.
Scene parted_room() {
  Scene s;
  const uint32_t wall = add_diffuse(s, Rgb{0.6f, 0.5f, 0.4f});
  add_box_inside(s, wall, {-2, -2, 0}, {2, 2, 2.5f});
  add_quad(s, add_paper(s, Rgb{0.3f, 0.3f, 0.2f}, Rgb{0.5f, 0.4f, 0.3f}),
           {Vec3{0, -2, 0}, {0, 2, 0}, {0, 2, 2.5f}, {0, -2, 2.5f}});
  const uint32_t black = add_diffuse(s, Rgb{0});
  make_light(
      s,
      add_quad(
          s, black,
          {Vec3{0.8f, -0.5f, 2.3f}, {0.8f, 0.5f, 2.3f}, {1.6f, 0.5f, 2.3f}, {1.6f, -0.5f, 2.3f}}),
      Rgb{10});
  // An object whose shadow is visible on the curtain.
  add_quad(s, wall,
           {Vec3{0.4f, -0.4f, 0.6f}, {0.4f, 0.4f, 0.6f}, {0.4f, 0.4f, 1.4f}, {0.4f, -0.4f, 1.4f}});
  return s;
}

Camera parted_camera() {
  return look_at({-1.9f, -1.2f, 1.3f}, {0, 0.2f, 1.1f}, {0, 0, 1}, 70);
}

RenderOptions small_picture(Method method) {
  RenderOptions o;
  o.method = method;
  o.indirect = Indirect::automatic;
  o.width = 32;
  o.height = 24;
  o.threads = 2;
  return o;
}

}  // namespace

TEST_CASE("translucent material without absorption is invisible in a furnace") {
  const PreparedScene scene(white_screens());
  RenderOptions o = small_picture(Method::path);
  o.spp = 16;
  const Ensemble e = render_ensemble(scene, screens_camera(), o, 16);
  // The coat conserves energy within .15 % (bsdf/bsdf.h).
  CHECK(pixels_off(
            e, [](size_t) { return 2.0; }, 3e-3) == 0);
  CHECK(e.mean.mean() == doctest::Approx(2).epsilon(2e-3));
  o = small_picture(Method::certified);
  o.indirect = Indirect::cells;
  const Image image = render_now(scene, screens_camera(), o).layers[0].image;
  double squares = 0;
  for (const Rgb& p : image.pixels) squares += std::pow(double(p.g) / 2 - 1, 2);
  CHECK(mean_green(image) == doctest::Approx(2).epsilon(0.004));
  CHECK(std::sqrt(squares / double(image.pixels.size())) < 0.05);
}

TEST_CASE("light through a round sheet agrees with the closed form") {
  // Nothing surrounds the sheet, so each side sees half of the surroundings. On the darker sheet
  // most paths end by Russian roulette, whichever side they arrive at.
  constexpr double radius = 5, height = 0.5, radiance = 3;
  for (const auto& [back, through] : {std::pair{0.3, 0.5}, {0.004, 0.016}}) {
    Scene s;
    const uint32_t paper = add_paper(s, Rgb{float(back)}, Rgb{float(through)});
    s.disks.push_back({{0, 0, float(height)}, {0, 0, 1}, float(radius), paper, no_light});
    Light& above = add_light(s, LightKind::sky, Rgb{float(radiance)});  // the ground is dark
    above.direction = {0, 0, -1};
    const PreparedScene scene(std::move(s));
    // The upper side receives pi L, the lower one nothing.
    const double share = radius * radius / (radius * radius + height * height);
    const double expected = 3.14159265358979 * radiance * (1 - share + share * through);
    for (const Method method : {Method::certified, Method::path}) {
      MeasureOptions o;
      o.method = method;
      o.spp = 1 << 15;
      o.threads = 2;
      const std::vector<MeasuringPoint> points{{{0, 0, 0}, {0, 0, 1}}};
      const Measurement m = measure(scene, points, o, {}, never_stopped).values[0];
      CAPTURE(method.row().name);
      CAPTURE(through);
      CHECK(double(m.irradiance.g) == doctest::Approx(expected).epsilon(0.004));
      CHECK(std::abs(double(m.irradiance.g) - expected) <
            5 * m.standard_error / 179 + 1e-4 * expected);
    }
  }
}

TEST_CASE("a curtain in front of a light: certified and cells agree with paths") {
  const PreparedScene scene(parted_room());
  RenderOptions o = small_picture(Method::path);
  o.spp = 4096;
  o.aovs = {Aov::direct, Aov::indirect};
  const RenderResult reference = render_now(scene, parted_camera(), o);
  o = small_picture(Method::certified);
  o.indirect = Indirect::cells;
  o.error = 0.02;
  o.aovs = {Aov::direct, Aov::indirect};
  const RenderResult r = render_now(scene, parted_camera(), o);
  for (size_t l = 0; l < 3; ++l) {
    CAPTURE(l);
    const Image &a = r.layers[l].image, &b = reference.layers[l].image;
    CHECK(mean(a) > 0);
    CHECK(mean(a) == doctest::Approx(mean(b)).epsilon(0.01));
    double squares = 0;
    for (size_t i = 0; i < a.pixels.size(); ++i)
      squares += std::pow(double(luminance(a.pixels[i]) - luminance(b.pixels[i])), 2);
    CHECK(std::sqrt(squares / double(a.pixels.size())) < 0.05 * mean(b));
  }
  // Without transmitted light everything would be dark here.
  o.threads = 1;
  CHECK(is_identical(render_now(scene, parted_camera(), o).layers, r.layers));
}

TEST_CASE("every method shows the direct light through a curtain") {
  const PreparedScene scene(parted_room());
  RenderOptions o = small_picture(Method::path);
  o.indirect = Indirect::none;
  o.spp = 1024;
  const double expected = mean(render_now(scene, parted_camera(), o).layers[0].image);
  CHECK(expected > 0.01);
  for (const Method method : {Method::certified, Method::fixed, Method::kj92}) {
    o.method = method;
    o.spp = 4;
    CAPTURE(method.row().name);
    const double found = mean(render_now(scene, parted_camera(), o).layers[0].image);
    CHECK(found == doctest::Approx(expected).epsilon(method == Method::kj92 ? 0.05 : 0.01));
  }
}
