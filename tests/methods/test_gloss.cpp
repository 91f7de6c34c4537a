// Gloss by certified visibility: the integrand at all samples of a mask, and rays that only find
// what is hidden.
#include <doctest/doctest.h>

#include <cmath>

#include "certified/source_integrand.h"
#include "methods/probe.h"

using namespace troffer;
using namespace troffer::test;

namespace test_gloss {

namespace {

// A rough floor under a panel. has_leaf: a leaf between the two makes lists incomplete.
Scene glossy_room(MaterialKind kind, float roughness, bool has_leaf, float panel = 1) {
  Scene s;
  Material m;
  m.kind = kind;
  m.base_color.value = Rgb{0.7f};
  m.roughness.value = roughness;
  m.is_reflectance = true;
  const uint32_t floor = add_material(s, m);
  add_quad(s, floor, {Vec3{-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0}});
  add_ceiling_light(s, panel, 2, Rgb{5});
  if (has_leaf)
    add_leaf(s, {Vec3{0, -0.1f, 1}, {0.4f, -0.1f, 1.1f}, {0.4f, 0.3f, 1.1f}, {0, 0.3f, 1}});
  return s;
}

double deviation(const Moments& m, int sets) {
  return std::sqrt(m.variance_of_mean() * sets);
}

constexpr Vec3 seen{0.9f, 0.4f, 0};
constexpr Vec3 eye{2.2f, 1.0f, 1.6f};

}  // namespace

TEST_CASE("gloss: an unoccluded source is nearly noise-free over rough metal and coats") {
  for (const MaterialKind kind : {MaterialKind::conductor, MaterialKind::coated_diffuse})
    for (const float roughness : {0.3f, 0.6f}) {
      const PreparedScene scene(glossy_room(kind, roughness, false));
      const Ray ray = ray_towards(eye, seen);
      const Probed got = probe(certified_integrator(scene), ray, 1, 2000, 5);
      const Probed reference = probe(fixed_integrator(scene, 64), ray, 16, 64, 3);
      CAPTURE(int(kind));
      CAPTURE(roughness);
      CHECK(p_of_difference(got.direct, reference.direct, 1e-3 * reference.direct.mean()) > 1e-4);
      MESSAGE(int(kind), ", ", roughness, ": deviation of a viewing ray ",
              deviation(got.direct, 2000) / got.direct.mean());
      // With 32 points drawn from the mask it would be up to .028.
      CHECK(deviation(got.direct, 2000) < 0.006 * got.direct.mean());
    }
}

// A few points of such a source then say what all say.
TEST_CASE("gloss: a source that is small beside the lobe is low-variance, however near or narrow") {
  const PreparedScene scene(glossy_room(MaterialKind::conductor, 0.3f, false));
  SourceIntegrand integrand(scene, 32, NominalSourceDensity(scene, 32));
  CertifiedSource panel;
  REQUIRE(make_flat_source(
      std::vector<Vec3>{{-0.5f, -0.5f, 2}, {-0.5f, 0.5f, 2}, {0.5f, 0.5f, 2}, {0.5f, -0.5f, 2}},
      panel.flat));
  GlossyHit gloss;
  gloss.wo = normalize(Vec3{0.5f, 0, 1});
  gloss.has_rough = true;
  integrand.sources() = {&panel};
  integrand.portals() = {nullptr};
  const auto is_low_variance = [&](float roughness, float below) {
    Material m;
    m.kind = MaterialKind::conductor;
    m.roughness.value = roughness;
    gloss.rough = make_bsdf(scene.bsdf_tables, {m}, {}, 0, {}, true);
    integrand.hits() = {{{0, 0, 2 - below}, &gloss}};
    return integrand.is_low_variance(0, 0);
  };
  const float alpha = 0.25f, lobe = 2 * alpha * gloss.wo.z;
  const float reach = 0.5f * std::sqrt(2.0f) * (1 + 1 / lobe);  // two lobes wide from there
  CHECK(is_low_variance(alpha, 1.01f * reach));
  CHECK(!is_low_variance(alpha, 0.99f * reach));
  CHECK(!is_low_variance(0.01f, 10));
  CHECK(!is_low_variance(1, 0.1f));
  gloss.has_rough = false;
  CHECK(is_low_variance(0.01f, 0.1f));
}

TEST_CASE("gloss: few points on a panel that is small beside the lobe cause no bias") {
  for (const float panel : {0.3f, 0.7f, 1.0f})
    for (const bool has_leaf : {false, true})
      for (const double error : {0.01, 0.05})
        for (const Vec3& point : {seen, Vec3{0.3f, 0.2f, 0}, Vec3{0.1f, 0.1f, 0}}) {
          const PreparedScene scene(glossy_room(MaterialKind::conductor, 0.6f, has_leaf, panel));
          const Ray ray = ray_towards(eye, point);
          const Probed got = probe(certified_integrator(scene, error), ray, 1, 2000, 5);
          const Probed reference = probe(fixed_integrator(scene, 64), ray, 16, 128, 3);
          CAPTURE(panel);
          CAPTURE(has_leaf);
          CAPTURE(error);
          CAPTURE(point.x);
          CAPTURE(got.direct.mean());
          CAPTURE(reference.direct.mean());
          CHECK(p_of_difference(got.direct, reference.direct, 1e-3 * reference.direct.mean()) >
                1e-4);
          if (!has_leaf)
            CHECK(deviation(got.direct, 2000) < (error < 0.02 ? 0.006 : 0.02) * got.direct.mean());
        }
}

TEST_CASE("gloss: where rays decide visibility, they are unbiased") {
  for (const MaterialKind kind : {MaterialKind::conductor, MaterialKind::coated_diffuse})
    for (const Vec3& point : {seen, Vec3{0.3f, 0.2f, 0}, Vec3{0.1f, -0.9f, 0}}) {
      const PreparedScene scene(glossy_room(kind, 0.3f, true));
      const Ray ray = ray_towards(eye, point);
      const Probed got = probe(certified_integrator(scene), ray, 4, 600, 5);
      const Probed reference = probe(fixed_integrator(scene, 64), ray, 16, 64, 3);
      CAPTURE(int(kind));
      CAPTURE(point.x);
      CHECK(p_of_difference(got.direct, reference.direct, 1e-3 * reference.direct.mean()) > 1e-4);
      MESSAGE(int(kind), ", x = ", point.x, ": deviation of 4 viewing rays ",
              deviation(got.direct, 600) / got.direct.mean());
      if (point.y < 0) CHECK(deviation(got.direct, 600) < 0.003 * got.direct.mean());  // open
    }
}

}  // namespace test_gloss
