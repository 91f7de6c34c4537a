// Glass under clear coats and films, and lights on invisible surfaces.
#include <doctest/doctest.h>

#include <cmath>

#include "base/units.h"
#include "render/furnace.h"
#include "render/measure.h"
#include "render/pictures.h"
#include "support/quadrature.h"
#include "support/scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace {

Material glass_of(float roughness, bool is_thin) {
  Material m;
  m.kind = MaterialKind::metallic_roughness;
  m.base_color.value = Rgb{1};
  m.metallic.value = 0;
  m.roughness.value = roughness;
  m.transmission.value = 1;
  m.is_thin = is_thin;
  return m;
}
Material coated(Material m, float roughness) {
  m.coat.value = 1;
  m.coat_roughness.value = roughness;
  return m;
}

// Returns the irradiance at the origin by a square light of side 1 and this radiance, `above`
// metres over it.
double irradiance_of(double radiance, double above, const std::function<double(double)>& through) {
  return radiance * integrate_2d(
                        [&](double x, double y) {
                          const double d2 = x * x + y * y + above * above;
                          const double c = above / std::sqrt(d2);
                          return c * c / d2 * through(c);
                        },
                        -0.5, 0.5, -0.5, 0.5, 20);
}

uint32_t add_square(Scene& s, uint32_t material, float half, float above) {
  return add_quad(
      s, material,
      {Vec3{-half, -half, above}, {-half, half, above}, {half, half, above}, {half, -half, above}});
}

void check_irradiance(const Scene& given, double expected) {
  const PreparedScene scene{Scene(given)};
  for (const Method method : {Method::certified, Method::path, Method::fixed}) {
    MeasureOptions o;
    o.method = method;
    o.spp = 1 << 14;
    o.threads = 2;
    const std::vector<MeasuringPoint> points{{{0, 0, 0}, {0, 0, 1}}};
    const Measurement m = measure(scene, points, o, {}, never_stopped).values[0];
    CAPTURE(method.row().name);
    CAPTURE(m.irradiance.g);
    CHECK(double(m.irradiance.g) == doctest::Approx(expected).epsilon(0.01));
    CHECK(std::abs(double(m.irradiance.g) - expected) <
          5 * m.standard_error / luminous_efficacy + 1e-3 * expected);
  }
}

}  // namespace

TEST_CASE("glass under coats and films is invisible in a furnace") {
  Scene s = uneven_furnace();
  const uint32_t ball = add_material(s, coated(glass_of(0, false), 0));
  s.spheres.push_back({{0.1f, -0.2f, 0.7f}, 0.4f, false, ball, no_light});
  const uint32_t pane = add_material(s, coated(glass_of(0, true), 0));
  add_quad(s, pane,
           {Vec3{-1, -0.9f, 0.5f}, {-0.5f, -1.1f, 0.5f}, {-0.5f, -1.1f, 1.5f}, {-1, -0.9f, 1.5f}});
  const uint32_t dull = add_material(s, coated(glass_of(0, true), 0.2f));
  add_quad(s, dull,
           {Vec3{0.5f, -0.9f, 0.5f}, {1, -1.1f, 0.5f}, {1, -1.1f, 1.5f}, {0.5f, -0.9f, 1.5f}});
  Material film = glass_of(0.4f, false);
  film.iridescence.value = 1;
  const uint32_t iridescent = add_material(s, film);
  s.spheres.push_back({{-1.4f, 0, 0.3f}, 0.3f, false, iridescent, no_light});
  const PreparedScene scene(std::move(s));
  RenderOptions o = furnace_options();
  const Ensemble e = render_ensemble(scene, furnace_camera(), o, 32);
  // Rough coats and films conserve energy within some percent per channel
  // (docs/reference/materials.md).
  CHECK(pixels_off(
            e, [](size_t) { return double(L0); }, 3e-2) == 0);
  CHECK(e.mean.mean() == doctest::Approx(double(L0)).epsilon(3e-3));
  o.method = Method::certified;
  o.max_spp = 64;
  const Image image = render_now(scene, furnace_camera(), o).layers[0].image;
  CHECK(mean_green(image) == doctest::Approx(double(L0)).epsilon(4e-3));
}

TEST_CASE("a lamp above a coated pane gives the same light by every method") {
  for (const float roughness : {0.0f, 0.3f}) {
    Scene s;
    const uint32_t black = add_diffuse(s, Rgb{0});
    const uint32_t pane = add_material(s, coated(glass_of(0, true), roughness));
    add_square(s, pane, 50, 1);
    make_light(s, add_square(s, black, 0.5f, 2), Rgb{7});
    const BsdfTables tables(s);
    const Bsdf bsdf = make_bsdf(tables, s, pane, {}, true);
    // 4 % less than bare glass.
    CHECK(double(straight_transmittance(bsdf, {0, 0, 1}).g) ==
          doctest::Approx(0.857).epsilon(0.02));
    CAPTURE(roughness);
    check_irradiance(
        s, irradiance_of(7, 2, [&](double c) {
          return double(straight_transmittance(
                            bsdf, {0, std::sqrt(std::max(0.0f, 1 - float(c * c))), float(c)})
                            .g);
        }));
  }
}

// Mitsuba's emitters on bsdfs "null".
TEST_CASE("a light that does not occlude adds to the light that passes through it") {
  Scene s;
  Material nothing;
  nothing.kind = MaterialKind::dielectric;
  nothing.base_color.value = Rgb{1};
  nothing.is_thin = true;
  nothing.ior = 1;
  const uint32_t black = add_diffuse(s, Rgb{0});
  make_light(s, add_square(s, black, 0.5f, 2), Rgb{7});
  make_light(s, add_square(s, add_material(s, nothing), 0.5f, 1), Rgb{3});
  const auto all = [](double) { return 1.0; };
  check_irradiance(s, irradiance_of(7, 2, all) + irradiance_of(3, 1, all));
  // The same where it is seen directly.
  const PreparedScene scene(std::move(s));
  for (const Method method : {Method::certified, Method::path, Method::fixed}) {
    RenderOptions o;
    o.method = method;
    o.width = o.height = 8;
    o.spp = 4;
    const Camera up = look_at({0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 10);
    const Image image = render_now(scene, up, o).layers[0].image;
    CAPTURE(method.row().name);
    CHECK(mean_green(image) == doctest::Approx(10).epsilon(1e-4));
  }
}
