// Pictures in which the value of every pixel is known.
#include <doctest/doctest.h>

#include <cmath>

#include "light/irradiance.h"
#include "render/furnace.h"
#include "render/pictures.h"
#include "support/light_scenes.h"

using namespace troffer;
using namespace troffer::test;

TEST_CASE("in a furnace every pixel is as bright as every other") {
  const PreparedScene scene(uneven_furnace());
  const RenderOptions o = furnace_options();
  const Ensemble e = render_ensemble(scene, furnace_camera(), o, 32);
  CHECK(pixels_off(
            e, [](size_t) { return double(L0); }, 1e-5) == 0);
  CAPTURE(e.mean.mean());
  CAPTURE(e.mean.standard_error());
  CHECK(p_of_mean(e.mean, double(L0), 1e-5 * double(L0)) > 1e-4);
  CHECK(e.mean.standard_error() < 2e-3 * double(L0));  // precise enough for the test
}

TEST_CASE("a furnace with glass, mirrors and gloss is uniform") {
  Scene s = uneven_furnace();
  Material glass;
  glass.kind = MaterialKind::dielectric;
  glass.base_color.value = Rgb{1};
  s.spheres.push_back({{0.1f, -0.2f, 0.7f}, 0.4f, false, add_material(s, glass), no_light});
  Material thin = glass;
  thin.is_thin = true;
  add_quad(s, add_material(s, thin),
           {Vec3{-1, -0.9f, 0.5f}, {-0.5f, -1.1f, 0.5f}, {-0.5f, -1.1f, 1.5f}, {-1, -0.9f, 1.5f}});
  Material metal;
  metal.kind = MaterialKind::conductor;
  metal.is_reflectance = true;
  metal.base_color.value = Rgb{1};
  metal.roughness.value = 0.3f;
  s.spheres.push_back({{1.4f, -0.2f, 0.5f}, 0.4f, false, add_material(s, metal), no_light});
  Material coated;
  coated.kind = MaterialKind::coated_diffuse;
  coated.base_color.value = Rgb{1};
  s.spheres.push_back({{-1.4f, 0, 0.3f}, 0.3f, false, add_material(s, coated), no_light});
  const PreparedScene scene(std::move(s));
  const RenderOptions o = furnace_options();
  const Ensemble e = render_ensemble(scene, furnace_camera(), o, 32);
  // Rough metal conserves energy within 0.15 % (bsdf/bsdf.h).
  CHECK(pixels_off(
            e, [](size_t) { return double(L0); }, 2e-3) == 0);
  CHECK(p_of_mean(e.mean, double(L0), 5e-4 * double(L0)) > 1e-4);
}

TEST_CASE("fixed and path agree with a floor of known radiance, pixel by pixel") {
  Scene s;
  const float rho = 0.6f;
  const uint32_t grey = add_diffuse(s, Rgb{rho});
  add_quad(s, grey, {Vec3{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}});
  add_ceiling_light(s, 1, 2, Rgb{10});
  add_sphere_light(s, 0, {2, 1, 1.2f}, 0.3f, Rgb{20});
  add_disk_light(s, 0, {-2, 1, 1.5f}, normalize(Vec3{1, 0, -1}), 0.4f, Rgb{15});
  const PreparedScene scene(std::move(s));
  // The camera looks straight down from below the sources, so no pixel shows them or their shadows.
  Camera camera = look_at({0, 0, 0.7f}, {0, 0, 0}, {0, 1, 0}, 100);
  RenderOptions o;
  o.method = Method::path;
  o.width = o.height = 16;
  o.indirect = Indirect::none;
  o.aovs = {Aov::position};
  // A pixel's mean over its square on the floor, by 3 × 3 Gauss points.
  const ViewingCamera view(camera, o.width, o.height);
  const auto expected = [&](size_t i) {
    const double nodes[] = {0.5 - std::sqrt(0.15), 0.5, 0.5 + std::sqrt(0.15)};
    const double weights[] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    double sum = 0;
    for (size_t a = 0; a < 3; ++a)
      for (size_t b = 0; b < 3; ++b) {
        const Vec2 raster{float(double(i % 16) + nodes[a]), float(double(i / 16) + nodes[b])};
        const Ray r = view.ray(raster, {0.5f, 0.5f});
        const Vec3 x = r.origin + r.direction * (-r.origin.z / r.direction.z);
        for (uint32_t e = 0; e < scene.scene.lights.size(); ++e)
          sum += weights[a] * weights[b] * double(scene.scene.lights[e].radiance.g) *
                 irradiance(scene.primitives, e, {double(x.x), double(x.y), 0}, {0, 0, 1});
      }
    return sum * double(rho) / pi;
  };
  for (const Method method : {Method::path, Method::fixed}) {
    o.method = method;
    o.spp = method == Method::path ? 64 : 4;
    o.shadow_rays = 16;
    const Ensemble e = render_ensemble(scene, camera, o, 24);
    CAPTURE(std::string(method.row().name));
    CHECK(pixels_off(e, expected, 1e-4) == 0);
    double all = 0;
    for (size_t i = 0; i < e.pixels.size(); ++i) all += expected(i) / double(e.pixels.size());
    CAPTURE(e.mean.mean());
    CAPTURE(all);
    CHECK(p_of_mean(e.mean, all, 1e-5 * all) > 1e-4);
  }
}

TEST_CASE("fixed and path agree on direct light with gloss, mirrors, glass and shadows") {
  const PreparedScene scene(mixed_room());
  RenderOptions o;
  o.method = Method::path;
  o.width = 24;
  o.height = 18;
  o.indirect = Indirect::none;
  o.spp = 32;
  const Ensemble path = render_ensemble(scene, mixed_room_camera(), o, 24);
  o.method = Method::fixed;
  o.spp = 16;
  o.shadow_rays = 4;
  o.seed = 1000;
  const Ensemble fixed = render_ensemble(scene, mixed_room_camera(), o, 24);
  CAPTURE(path.mean.mean());
  CAPTURE(fixed.mean.mean());
  CHECK(p_of_difference(path.mean, fixed.mean) > 1e-4);
  const double significance = sidak(1e-3, int(path.pixels.size()));
  size_t off = 0;
  for (size_t i = 0; i < path.pixels.size(); ++i)
    off += p_of_difference(path.pixels[i], fixed.pixels[i], 1e-5) < significance;
  CHECK(off == 0);
}
