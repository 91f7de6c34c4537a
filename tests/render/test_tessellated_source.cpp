// A panel that is cut into thousands of triangles gives the same light as the whole panel. A panel
// that is not quite flat does not hide its own light.
#include <doctest/doctest.h>

#include <cmath>

#include "import/emissive.h"
#include "render/measure.h"
#include "render/pictures.h"
#include "support/light_scenes.h"
#include "support/tessellations.h"

using namespace troffer;
using namespace troffer::test;

namespace {

constexpr double width = 1.4, height = 0.9;

Scene room() {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.6f, 0.5f, 0.4f});
  add_box_inside(s, grey, {-2, -2, 0}, {2, 2, 2.5f});
  add_quad(
      s, grey,
      {Vec3{-0.6f, -0.5f, 0.8f}, {0.7f, -0.5f, 0.8f}, {0.7f, 0.6f, 0.8f}, {-0.6f, 0.6f, 0.8f}});
  add_quad(s, grey,
           {Vec3{0.9f, -0.5f, 0}, {0.9f, 0.5f, 0}, {0.9f, 0.5f, 1.5f}, {0.9f, -0.5f, 1.5f}});
  return s;
}

// Tilted, facing down.
Place place_of_panel() {
  Place p;
  p.frame = Framed(normalize(Vec3d{0.2, 0.3, -1}));
  p.origin =
      Vec3d{0.1, -0.2, 2.2} - p.frame.tangent * (width / 2) - p.frame.bitangent * (height / 2);
  return p;
}

RenderOptions options() {
  RenderOptions o;
  o.method = Method::certified;
  o.max_spp = o.spp;  // the same viewing rays in both pictures
  o.indirect = Indirect::none;
  o.width = 64;
  o.height = 48;
  o.threads = 2;
  return o;
}

}  // namespace

TEST_CASE("certified: a panel of 20 000 triangles is one source and needs no ray") {
  Scene whole = room(), cut = room();
  const Place place = place_of_panel();
  make_light(whole,
             add_quad(whole, 0,
                      {place.at({0, 0}), place.at({width, 0}), place.at({width, height}),
                       place.at({0, height})}),
             Rgb{5});
  Random r(3);
  Mesh m;
  append(m, random_grid(r, 100, 100, width, height), place);
  CHECK(m.triangles.size() == 20000);
  add_mesh_light(cut, 0, m.positions, m.triangles, Rgb{5}, false);
  const Camera camera = look_at({-1.7f, -1.8f, 1.4f}, {0.3f, 0.5f, 0.2f}, {0, 0, 1}, 60);
  const RenderResult a = render_now(PreparedScene(std::move(whole)), camera, options());
  const RenderResult b = render_now(PreparedScene(std::move(cut)), camera, options());
  for (const RenderResult* result : {&a, &b}) {
    CHECK(result->statistics.counters.shadow_rays == 0);
    CHECK(result->statistics.counters.lit_certified > 0);
  }
  CHECK(a.statistics.counters.lit_certified == b.statistics.counters.lit_certified);
  CHECK(a.statistics.counters.masked == b.statistics.counters.masked);
  const Image &p = a.layers[0].image, &q = b.layers[0].image;
  double square = 0;
  for (size_t i = 0; i < p.pixels.size(); ++i)
    square += std::pow(double(p.pixels[i].g) - double(q.pixels[i].g), 2);
  const double rms = std::sqrt(square / double(p.pixels.size()));
  CHECK(mean_green(p) > 0);
  CHECK(rms < 0.01 * mean_green(p));
  CHECK(mean_green(q) == doctest::Approx(mean_green(p)).epsilon(0.001));
}

TEST_CASE("certified: a panel does not light its own back") {
  Scene s;
  add_diffuse(s, Rgb{0.5f});
  Random r(4);
  Mesh m;
  append(m, random_grid(r, 10, 10, width, height), place_of_panel());
  add_mesh_light(s, 0, m.positions, m.triangles, Rgb{5}, false);
  const Camera from_above = look_at({0.3f, 0.5f, 4}, {0.1f, -0.2f, 2.2f}, {0, 1, 0}, 15);
  const RenderResult result = render_now(PreparedScene(std::move(s)), from_above, options());
  CHECK(mean_green(result.layers[0].image) == 0);
}

TEST_CASE("a panel whose corner stands out by 1 µm to 1 mm keeps its light") {
  // Irradiance 2 m below the middle of a square of 1 m: 4 L a atan(a), a = x / √(1 + x²), x = 1/4.
  const double a = 0.25 / std::sqrt(1 + 0.25 * 0.25), exact = 4 * 100 * a * std::atan(a);
  for (const uint32_t corner : {1u, 2u}) {
    for (const float off : {1e-6f, 1e-5f, 1e-4f, 1e-3f, -1e-6f, -1e-5f, -1e-4f, -1e-3f}) {
      Scene s;
      Mesh m;
      m.material = add_diffuse(s, Rgb{0.0f});
      m.positions = {{-0.5f, -0.5f, 2}, {-0.5f, 0.5f, 2}, {0.5f, 0.5f, 2}, {0.5f, -0.5f, 2}};
      m.triangles = {{0, 1, 2}, {0, 2, 3}};
      m.positions[corner].z += off;
      s.meshes.push_back(m);
      add_mesh_lights(s, 0, {"panel", Rgb{100.0f}});
      const PreparedScene prepared(std::move(s));
      const std::vector<MeasuringPoint> points{{{0, 0, 0}, {0, 0, 1}}};
      CAPTURE(corner);
      CAPTURE(off);
      for (const Method method : {Method::certified, Method::path, Method::fixed}) {
        MeasureOptions o;
        o.method = method;
        o.indirect = Indirect::none;
        const MeasureResult r = measure(prepared, points, o, {}, never_stopped);
        CHECK(double(r.values[0].irradiance.g) == doctest::Approx(exact).epsilon(0.005));
      }
    }
  }
}
