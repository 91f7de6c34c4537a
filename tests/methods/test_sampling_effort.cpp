// Sampling effort: rays of pixels that meet different things get fewer light samples, without bias.
#include <doctest/doctest.h>

#include <cmath>

#include "methods/probe.h"
#include "support/surfaceless_lights.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// A matte or glossy floor below n lights and a beam, with or without a sky.
Scene floor_below(int n, bool is_glossy, bool has_sky) {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  if (is_glossy) {
    s.materials[grey].kind = MaterialKind::coated_diffuse;
    s.materials[grey].roughness.value = 0.4f;
  }
  add_quad(s, grey, {Vec3{-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0}});
  const uint32_t matte = add_diffuse(s, Rgb{0.5f});
  for (int i = 0; i < n; ++i) {
    const float x = -2 + 4 * (float(i) + 0.5f) / float(n), r = 1.5f / float(n);
    const uint32_t quad =
        add_quad(s, matte, {Vec3{x - r, -1, 2}, {x - r, 1, 2}, {x + r, 1, 2}, {x + r, -1, 2}});
    make_light(s, quad, Rgb{1.0f + float(i % 3)});
  }
  add_block(s, matte, {0.1f, -0.5f, 1}, {0.4f, 0.5f, 1.1f});
  if (has_sky) add_environment(s, Rgb{0.4f});
  return s;
}

// Lights a scene like further rays of a pixel in a picture by cells.
WaveIntegrator drawing(const PreparedScene& scene) {
  CertifiedSettings settings = certified_settings(0.1, scene.scene.lights.size());
  settings.draws = 16;
  settings.matte_draw_factor = 2;
  return {scene,
          std::make_unique<CertifiedDirect>(scene, std::make_shared<const Occluders>(scene.scene),
                                            settings),
          nullptr};
}

}  // namespace

TEST_CASE("with lower sampling effort rays get fewer points and the same mean light") {
  constexpr float typical =
      0.5f;  // luminance of the picture: not all points of the sky are sampled
  const Ray ray = ray_towards({1.2f, 0.3f, 0.9f}, {0.9f, 0.1f, 0});
  for (const int lights : {0, 5, 40})  // none, few and many
    for (const bool is_glossy : {false, true})
      for (const bool has_sky : {false, true}) {
        if (lights == 0 && !has_sky) continue;
        CAPTURE(lights);
        CAPTURE(is_glossy);
        CAPTURE(has_sky);
        const PreparedScene scene(floor_below(lights, is_glossy, has_sky));
        const WaveIntegrator integrator = drawing(scene);
        const Probed usual = probe(integrator, ray, 64, 60, 0, 1, typical);
        REQUIRE(usual.total.mean() > 0.1);
        uint64_t last = 0;
        for (const uint32_t effort_divisor : {SampleRequest::most_effort_divisor, 4u}) {
          CAPTURE(effort_divisor);
          const Probed some = probe(integrator, ray, 64, 200, 7, effort_divisor, typical);
          const double sigma =
              std::sqrt(usual.total.variance_of_mean() + some.total.variance_of_mean());
          CAPTURE(usual.total.mean());
          CAPTURE(some.total.mean());
          CHECK(std::abs(some.total.mean() - usual.total.mean()) <
                5 * sigma + 0.004 * usual.total.mean());
          CHECK(some.shadow_rays > last);
          last = some.shadow_rays;
          if (lights == 0)
            CHECK(double(some.shadow_rays) / 200 < 0.5 * double(usual.shadow_rays) / 60);
          // Each ray samples this many points of lights; points that send nothing cast no shadow
          // ray.
          if (!has_sky) {
            CHECK(some.shadow_rays <= 200 * 64 * (is_glossy ? 16 : 32) / effort_divisor);
            CHECK(some.shadow_rays > 200 * 64 * (is_glossy ? 8 : 16) / effort_divisor);
          }
        }
      }
}
