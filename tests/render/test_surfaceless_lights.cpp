// Points, spots, distant lights and environments in every method: closed forms, furnaces, threads.
#include <doctest/doctest.h>

#include <cmath>

#include "base/warp.h"
#include "daylight/sky_lights.h"
#include "light/light.h"
#include "pictures.h"
#include "render/measure.h"
#include "render/radiosity.h"
#include "support/light_scenes.h"
#include "support/surfaceless_lights.h"

using namespace troffer;
using namespace troffer::test;

namespace {

const Method all_methods[] = {Method::path, Method::fixed, Method::certified, Method::kj92};
const Vec3 lamp{0.5f, -0.3f, 2};

Scene floor_of(float reflectance) {
  Scene s;
  add_quad(s, add_diffuse(s, Rgb{reflectance}),
           {Vec3{-3, -3, 0}, {3, -3, 0}, {3, 3, 0}, {-3, 3, 0}});
  return s;
}

// Irradiance by one method, green channel, straight from lights.
std::vector<Measurement> measured(const PreparedScene& scene,
                                  const std::vector<MeasuringPoint>& points, Method method,
                                  int spp) {
  MeasureOptions o;
  o.method = method;
  o.spp = spp;
  o.indirect = Indirect::none;
  o.threads = 2;
  return measure(scene, points, o, {}, never_stopped).values;
}

RenderOptions small(Method method) {
  RenderOptions o;
  o.method = method;
  o.width = 12;
  o.height = 8;
  o.spp = 4;
  o.shadow_rays = 16;
  o.threads = 2;
  o.kj92.radiosity.meshing.element_size = 0.5f;
  o.kj92.radiosity.meshing.patch_size = 1.5f;
  return o;
}

}  // namespace

TEST_CASE("every method measures points, spots and distant lights as their closed forms say") {
  struct Case {
    const char* name;
    void (*add)(Scene&);
    double (*irradiance)(const Vec3d& x);
  };
  const Case cases[] = {
      {"point", [](Scene& s) { add_point(s, lamp, Rgb{7}); },
       [](const Vec3d& x) {
         const Vec3d to = Vec3d(lamp) - x;
         return 7 * to.z / std::pow(length(to), 3);
       }},
      {"spot",
       [](Scene& s) {
         add_spot(s, lamp, {0, 0, -1}, 0.95f, 0.8f, Rgb{7});
       },
       [](const Vec3d& x) {
         const Vec3d to = Vec3d(lamp) - x;
         const double t = std::clamp((to.z / length(to) - 0.8) / 0.15, 0.0, 1.0);
         return 7 * t * t * (3 - 2 * t) * to.z / std::pow(length(to), 3);
       }},
      {"distant",
       [](Scene& s) {
         add_distant(s, {1, 0, -2}, Rgb{7});
       },
       [](const Vec3d&) { return 7 * 2 / std::sqrt(5.0); }},
  };
  const std::vector<MeasuringPoint> points{
      {{0.5f, -0.3f, 0}, {0, 0, 1}}, {{1.2f, 0.2f, 0}, {0, 0, 1}}, {{-1, 1.5f, 0}, {0, 0, 2}}};
  for (const Case& c : cases) {
    Scene s = floor_of(0.5f);
    c.add(s);
    const PreparedScene scene(std::move(s));
    for (const Method method : all_methods) {
      const auto values = measured(scene, points, method, 16);
      for (size_t i = 0; i < points.size(); ++i) {
        CAPTURE(c.name);
        CAPTURE(std::string(method.row().name));
        CAPTURE(i);
        CHECK(double(values[i].irradiance.g) ==
              doctest::Approx(c.irradiance(Vec3d(points[i].position))).epsilon(1e-4));
      }
    }
  }
}

TEST_CASE("objects in front of a point or a distant light block it, with every method") {
  Scene s = floor_of(0.5f);
  add_quad(s, 0, {Vec3{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}});
  add_point(s, {0, 0, 2}, Rgb{7});
  add_distant(s, {0, 0, -1}, Rgb{3});
  const PreparedScene scene(std::move(s));
  const std::vector<MeasuringPoint> points{
      {{0.2f, 0.1f, 0}, {0, 0, 1}}, {{1.5f, 0, 0}, {0, 0, 1}}, {{2.5f, 0, 0}, {0, 0, 1}}};
  const double expected[] = {0, 3, 3 + 14 / std::pow(4 + 2.5 * 2.5, 1.5)};
  for (const Method method : all_methods) {
    const auto values = measured(scene, points, method, method == Method::path ? 4096 : 16);
    for (size_t i = 0; i < points.size(); ++i) {
      CAPTURE(std::string(method.row().name));
      CAPTURE(i);
      const double error = values[i].standard_error / luminous_efficacy;
      CHECK(std::abs(double(values[i].irradiance.g) - expected[i]) < 1e-4 + 5 * error);
      CHECK(error < 0.05);
    }
  }
}

TEST_CASE("an open plane under a constant environment gets pi L, with every method") {
  Scene s = floor_of(0.5f);
  add_environment(s, Rgb{2});
  const PreparedScene scene(std::move(s));
  const std::vector<MeasuringPoint> points{{{0.5f, -0.3f, 0}, {0, 0, 1}},
                                           {{1.2f, 0.2f, 0}, {0, 0, 1}}};
  for (const Method method : all_methods)
    for (const Measurement& m : measured(scene, points, method, 4096)) {
      CAPTURE(std::string(method.row().name));
      const double error = m.standard_error / luminous_efficacy;
      CHECK(std::abs(double(m.irradiance.g) - 2 * pi) < 1e-4 + 5 * error);
      CHECK(error < 0.1);
    }
}

TEST_CASE("an open plane gets the illuminance of a sky, a sun and an image, with every method") {
  Scene s = floor_of(0.5f);
  SkyRequest request;
  request.kind = SkyKind::cie;
  request.cie_type = 12;
  request.diffuse_lx = 9000;
  request.sun = SunRequest{120, 40, 1, 50'000.0};
  add_sky(s, request, make_compass({0, 0, 1}, 0, false));
  // An image that is bright in one texel above and uniform below.
  EnvironmentMap map;
  map.width = 16;
  map.height = 8;
  map.texels.assign(16 * 8, Rgb{0.5f});
  map.texels[1 * 16 + 3] = Rgb{4000};
  add_environment(s, map, 1, 0, make_compass({0, 0, 1}, 0, false));
  const PreparedScene scene(std::move(s));
  double image = 0;
  constexpr int n = 1000;
  for (int i = 0; i < n * n; ++i) {
    const Vec3 w =
        cosine_hemisphere_from_square({(float(i % n) + 0.5f) / n, (float(i / n) + 0.5f) / n});
    image += double(radiance_at_infinity(scene.scene, scene.primitives[2], {}, w).g) * pi / (n * n);
  }
  const double expected =
      (9000 + 50'000 * std::sin(rad_from_deg(40.0))) / luminous_efficacy + image;
  const std::vector<MeasuringPoint> points{{{0.5f, -0.3f, 0}, {0, 0, 1}}};
  for (const Method method : all_methods)
    for (const Measurement& m : measured(scene, points, method, 4096)) {
      CAPTURE(std::string(method.row().name));
      const double error = m.standard_error / luminous_efficacy;
      // Rays of a bintree that agree with each other may miss a small part of a source (kj92).
      const double bias = method == Method::kj92 ? 0.02 : 2e-4;
      CHECK(std::abs(double(m.irradiance.g) - expected) < bias * expected + 5 * error);
      CHECK(error < 0.02 * expected);
    }
}

TEST_CASE("a convex body in a white environment is a furnace for any material") {
  const auto white = [](MaterialKind kind, float roughness) {
    Material m;
    m.kind = kind;
    m.is_reflectance = kind == MaterialKind::conductor;
    m.base_color.value = Rgb{1};
    m.roughness.value = roughness;
    return m;
  };
  struct Case {
    const char* name;
    Material material;
    float loss;  // metals reflect all but .0001; rough ones within 0.15 % (bsdf/bsdf.h)
  };
  const Case cases[] = {{"matte", white(MaterialKind::diffuse, 0), 1e-5f},
                        {"mirror", white(MaterialKind::conductor, 0), 1.2e-4f},
                        {"rough metal", white(MaterialKind::conductor, 0.3f), 2e-3f},
                        {"glass", white(MaterialKind::dielectric, 0), 1e-5f}};
  for (const Case& c : cases) {
    Scene s;
    s.spheres.push_back({{0, 0, 0}, 1, false, add_material(s, c.material), no_light});
    add_environment(s, Rgb{3});
    const PreparedScene scene(std::move(s));
    const Camera camera = look_at({0, -4, 1}, {0, 0, 0}, {0, 0, 1}, 40);
    for (const Method method : all_methods) {
      // Methods without indirect light lose what a glass ball reflects inside.
      if (c.material.kind == MaterialKind::dielectric && method != Method::path) continue;
      const Ensemble e = render_ensemble(scene, camera, small(method), 24);
      CAPTURE(c.name);
      CAPTURE(std::string(method.row().name));
      CAPTURE(e.mean.mean());
      CAPTURE(e.mean.standard_error());
      // Rays of a bintree that agree with each other may miss a small part of a source (kj92).
      const double bias = method == Method::kj92 ? 0.02 : 0.0;
      CHECK(pixels_off(
                e, [](size_t) { return 3.0; }, double(c.loss) + bias) == 0);
      CHECK(p_of_mean(e.mean, 3, 3 * (double(c.loss) + bias)) > 1e-4);
      CHECK(e.mean.standard_error() < 0.05);
    }
  }
}

TEST_CASE("a viewing ray that misses shows the environment, and nothing without one") {
  for (const float L : {0.0f, 1.0f}) {
    Scene s = floor_of(0.5f);
    if (L > 0) add_environment(s, Rgb{1, 2, 3} * L);
    add_point(s, lamp, Rgb{1});  // not visible
    const PreparedScene scene(std::move(s));
    const Camera up = look_at({0, 0, 1}, {0, 0, 5}, {0, 1, 0}, 60);
    for (const Method method : all_methods) {
      const Image image = render_now(scene, up, small(method)).layers[0].image;
      for (const Rgb& p : image.pixels) {
        CAPTURE(std::string(method.row().name));
        CHECK(p.r == L);
        CHECK(p.g == 2 * L);
        CHECK(p.b == 3 * L);
      }
    }
  }
}

TEST_CASE("lights of all kinds together: the same bytes for 1 and 4 threads, the same mean") {
  Scene s = floor_of(0.5f);
  Material gloss;
  gloss.kind = MaterialKind::coated_diffuse;
  gloss.base_color.value = Rgb{0.4f, 0.5f, 0.6f};
  gloss.roughness.value = 0.2f;
  const uint32_t coated = add_material(s, gloss);
  s.spheres.push_back({{0.3f, 0.3f, 0.5f}, 0.5f, false, coated, no_light});
  add_quad(s, coated,
           {Vec3{-1.5f, -1, 0.3f}, {-0.5f, -1, 0.3f}, {-0.5f, 0, 0.3f}, {-1.5f, 0, 0.3f}});
  add_ceiling_light(s, 1, 2.4f, Rgb{8});
  add_environment(s, Rgb{0.5f, 0.7f, 1});
  add_point(s, {-1, -1, 1.5f}, Rgb{2});
  add_distant(s, {1, 1, -2}, Rgb{1.5f});
  add_spot(s, {1, -1, 2}, {0, 0, -1}, 0.95f, 0.8f, Rgb{5});
  const PreparedScene scene(std::move(s));
  const Camera camera = look_at({-2, -2.5f, 1.6f}, {0, 0, 0.3f}, {0, 0, 1}, 50);
  Moments reference;
  for (const Method method : all_methods) {
    RenderOptions o = small(method);
    o.indirect = method == Method::kj92 ? Indirect::automatic : Indirect::none;
    o.aovs = {Aov::direct};
    const RenderResult a = render_now(scene, camera, [&] {
      o.threads = 1;
      return o;
    }());
    const RenderResult b = render_now(scene, camera, [&] {
      o.threads = 4;
      return o;
    }());
    CAPTURE(std::string(method.row().name));
    CHECK(is_identical(a.layers, b.layers));
    // Direct light alone, on which all methods agree within noise.
    o.aovs = {Aov::direct};
    Moments direct;
    for (o.seed = 0; o.seed < 24; ++o.seed)
      direct.add(mean_green(render_now(scene, camera, o).layers[1].image));
    if (method == Method::path) {
      reference = direct;
      continue;
    }
    CAPTURE(direct.mean());
    CAPTURE(reference.mean());
    const double rounding = method == Method::kj92 ? 0.01 * reference.mean() : 0.0;
    CHECK(p_of_difference(direct, reference, rounding) > 1e-4);
    CHECK(direct.standard_error() < 0.01 * direct.mean());
  }
}

TEST_CASE("the preprocessing reports the lights that it leaves out") {
  Scene s = floor_of(0.5f);
  add_ceiling_light(s, 1, 2, Rgb{5});
  CHECK(lights_left_out(s).empty());
  add_point(s, lamp, Rgb{1});
  CHECK(lights_left_out(s).find("1 light ") != std::string::npos);
  add_environment(s, Rgb{1});
  CHECK(lights_left_out(s).find("2 lights ") != std::string::npos);
}
