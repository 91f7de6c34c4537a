// Mirrors, glass, many bounces, and the order of work.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "light/irradiance.h"
#include "probe.h"

using namespace troffer;
using namespace troffer::test;

namespace {

PathIntegrator path(const PreparedScene& scene, int depth = -1) {
  PathOptions o;
  o.depth = depth;
  return PathIntegrator(scene, o);
}

// A room whose six walls emit (1 - rho) L0, so that radiance is L0 everywhere. Things in it absorb
// nothing.
constexpr float L0 = 2;
Scene furnace(float rho) {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{rho});
  for (const uint32_t quad : add_box_inside(s, grey, {-2, -2, -2}, {2, 2, 2}))
    make_light(s, quad, Rgb{(1 - rho) * L0});
  return s;
}

}  // namespace

TEST_CASE("a mirror shows the source with its own radiance") {
  Scene s;
  const uint32_t mirror = add_mirror(s);
  add_quad(s, mirror, {Vec3{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}});
  add_ceiling_light(s, 1, 2, Rgb{3});
  const PreparedScene scene(std::move(s));
  const Ray at_source = ray_towards({-1, 0, 1}, {-0.6f, 0, 0});  // meets it at (0.2, 0, 2)
  const Ray past_it = ray_towards({-1, 0, 1}, {1, 0, 0});
  for (const int depth : {-1, 1, 3}) {
    const Probed seen = probe(path(scene, depth), at_source, 16, 4);
    CHECK(seen.direct.mean() == doctest::Approx(3).epsilon(2e-4));
    CHECK(seen.indirect.mean() == 0);
    CHECK(probe(path(scene, depth), past_it, 16, 4).total.mean() == 0);
  }
  CHECK(probe(path(scene, 0), at_source, 16, 4).total.mean() == 0);
  const WaveIntegrator fixed = troffer::test::fixed_integrator(scene, 4);
  CHECK(probe(fixed, at_source, 16, 4).total.mean() == doctest::Approx(3).epsilon(2e-4));
  CHECK(probe(fixed, past_it, 16, 4).total.mean() == 0);
}

TEST_CASE("a mirror shows a lit floor as it is") {
  Scene s;
  const uint32_t mirror = add_mirror(s), grey = add_diffuse(s, Rgb{0.5f});
  add_quad(s, mirror, {Vec3{3, -5, 0}, {3, -5, 5}, {3, 5, 5}, {3, 5, 0}});
  add_quad(s, grey, {Vec3{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}});
  add_ceiling_light(s, 1, 2, Rgb{3});
  const PreparedScene scene(std::move(s));
  // The ray goes by way of (3, 0, 1) to (1, 0, 0), which the source's mirror image does not light.
  // Caustics are left to paths that meet the source by chance.
  const Ray ray = ray_towards({1, 0, 2}, {3, 0, 1});
  const double expected = 0.5 * 3 / pi * irradiance(scene.primitives, 0, {1, 0, 0}, {0, 0, 1});
  const WaveIntegrator fixed = troffer::test::fixed_integrator(scene, 4);
  CHECK(p_of_mean(probe(fixed, ray, 32, 32).direct, expected, 1e-5) > 1e-4);
  CHECK(p_of_mean(probe(path(scene, 2), ray, 128, 32).direct, expected, 1e-5) > 1e-4);
}

TEST_CASE("paths between facing mirrors end") {
  Scene s;
  const uint32_t mirror = add_mirror(s);
  add_box_inside(s, mirror, {-1, -1, -1}, {1, 1, 1});
  add_ceiling_light(s, 0.5f, 0.5f, Rgb{1});
  const PreparedScene scene(std::move(s));
  const WaveIntegrator fixed = troffer::test::fixed_integrator(scene, 4);
  const Ray ray = ray_towards({0, 0, 0}, {1, 0.3f, -0.2f});
  CHECK(std::isfinite(probe(fixed, ray, 16, 4).total.mean()));
  CHECK(std::isfinite(probe(path(scene), ray, 16, 4).total.mean()));
}

TEST_CASE("paths in closed white rooms end, with and without light") {
  for (const bool has_light : {false, true}) {
    Scene s;
    const uint32_t white = add_diffuse(s, Rgb{1});
    const auto quads = add_box_inside(s, white, {-1, -1, -1}, {1, 1, 1});
    if (has_light) make_light(s, quads[1], Rgb{1});
    const PreparedScene scene(std::move(s));
    const Probed p = probe(path(scene), ray_towards({0, 0, 0}, {1, 0.3f, -0.2f}), 16, 4);
    CHECK(std::isfinite(p.total.mean()));
    if (!has_light) CHECK(p.total.mean() == 0);
  }
}

TEST_CASE("glass in a furnace changes nothing") {
  const double significance = sidak(1e-3, 12);
  const Vec3 from{-1.5f, -1, 0.4f};
  for (const bool is_thin : {true, false})
    for (const bool is_rough : {false, true}) {
      Scene s = furnace(0.5f);
      const uint32_t glass = add_glass(s, is_thin, is_rough ? 0.3f : 0.0f);
      if (is_thin)
        add_quad(s, glass, {Vec3{0, -1, -1}, {0, 1, -1}, {0, 1, 1}, {0, -1, 1}});
      else
        add_block(s, glass, {-0.2f, -1, -1}, {0.2f, 1, 1});
      const PreparedScene scene(std::move(s));
      for (const Vec3 to : {Vec3{0, 0, 0}, {0, 0.5f, -0.3f}, {0, -0.2f, 0.9f}}) {
        const Probed p = probe(path(scene), ray_towards(from, to), 128, 32);
        CAPTURE(is_thin);
        CAPTURE(is_rough);
        CAPTURE(p.total.mean());
        CAPTURE(p.total.standard_error());
        // Rough glass keeps its energy within 0.6 % per passage (bsdf/bsdf.h).
        CHECK(p_of_mean(p.total, double(L0), is_rough ? 0.01 * double(L0) : 1e-4) > significance);
      }
    }
}

TEST_CASE("a sphere that shines inwards lights itself") {
  const float rho = 0.5f;
  for (const bool is_two_sided : {true, false})
    for (const Vec3 centre : {Vec3{0, 0, 0}, {-8, 3, 1}}) {
      Scene s;
      add_sphere_light(s, add_diffuse(s, Rgb{rho}), centre, 0.3f, Rgb{(1 - rho) * L0}, is_two_sided,
                       !is_two_sided);
      const PreparedScene scene(std::move(s));
      const WaveIntegrator fixed = troffer::test::fixed_integrator(scene, 4);
      for (const Vec3 to : {Vec3{1, 0, 0}, {0.3f, 0.5f, -0.6f}}) {
        const Ray ray = ray_towards(centre + to * 0.1f, centre + to * -1.0f);
        CAPTURE(is_two_sided);
        CAPTURE(centre.x);
        const Probed all = probe(path(scene), ray, 64, 32);
        CAPTURE(all.total.mean());
        CHECK(p_of_mean(all.total, double(L0), 1e-4) > sidak(1e-3, 8));
        const double direct = double(L0) * (1 - double(rho) * double(rho));
        CHECK(p_of_mean(probe(path(scene, 1), ray, 64, 32).total, direct, 1e-4) > sidak(1e-3, 8));
        CHECK(p_of_mean(probe(fixed, ray, 16, 32).total, direct, 1e-4) > sidak(1e-3, 8));
      }
    }
}

TEST_CASE("a glass sphere in a furnace changes nothing") {
  Scene s = furnace(0.5f);
  const uint32_t glass = add_glass(s, false);
  s.spheres.push_back({{0, 0, 0}, 0.7f, false, glass, no_light});
  const PreparedScene scene(std::move(s));
  for (const float y : {0.0f, 0.3f, 0.65f}) {
    const Probed p = probe(path(scene), ray_towards({-1.5f, y, 0.1f}, {0, y, 0}), 128, 32);
    CAPTURE(y);
    CAPTURE(p.total.mean());
    CHECK(p_of_mean(p.total, double(L0), 1e-4) > sidak(1e-3, 3));
  }
}

TEST_CASE("every bounce adds light, and bounces add up to the total") {
  // In the furnace of reflectance rho, depth d gives L0 (1 - rho^(d+1)).
  const float rho = 0.5f;
  const PreparedScene scene(furnace(rho));
  const Ray ray = ray_towards({0, 0, 0}, {1, 0.3f, -0.2f});
  double before = 0;
  for (const int depth : {0, 1, 2, 5}) {
    const Probed p = probe(path(scene, depth), ray, 256, 32);
    const double expected = double(L0) * (1 - std::pow(double(rho), depth + 1));
    CAPTURE(depth);
    CHECK(p_of_mean(p.total, expected, 1e-5) > sidak(1e-3, 4));
    CHECK(p.total.mean() > before);
    before = p.total.mean();
    const double direct = double(L0) * (1 - std::pow(double(rho), std::min(depth, 1) + 1));
    CHECK(p_of_mean(p.direct, direct, 1e-5) > sidak(1e-3, 4));
    if (depth < 2) CHECK(p.indirect.mean() == 0);
  }
}

TEST_CASE("invalid rays hit nothing and do not affect others in their batch") {
  const PreparedScene scene(furnace(0.5f));
  std::vector<Ray> rays(35, ray_towards({0, 0, 0}, {1, 0.3f, -0.2f}));
  rays[3].direction.x = std::nanf("");
  rays[17].origin.y = 1e30f;
  rays[33].origin.z = -std::numeric_limits<float>::infinity();
  for (const Coherence c : {Coherence::coherent, Coherence::none}) {
    std::vector<Hit> hits(rays.size());
    std::vector<uint8_t> is_occluded(rays.size());
    scene.tracer.closest(rays, hits, c);
    scene.tracer.occluded(rays, is_occluded, c);
    for (size_t i = 0; i < rays.size(); ++i) {
      CHECK(hits[i].is_valid() == (i != 3 && i != 17 && i != 33));
      CHECK(is_occluded[i] == 1);
    }
  }
}

TEST_CASE("results do not depend on how rays are divided into batches") {
  Scene s = furnace(0.5f);
  const uint32_t glass = add_glass(s, false), mirror = add_mirror(s);
  add_block(s, glass, {-0.2f, -1, -1}, {0.2f, 1, 1});
  s.spheres.push_back({{1, 0, 0}, 0.3f, false, mirror, no_light});
  const PreparedScene scene(std::move(s));
  const PathIntegrator path_integrator = path(scene);
  const WaveIntegrator fixed_integrator = troffer::test::fixed_integrator(scene, 3);
  Random r(5);
  ViewingRays rays;
  for (uint32_t i = 0; i < 500; ++i) {
    rays.rays.push_back(ray_towards({-1, 0, 0}, Vec3{-1, 0, 0} + random_direction(r)));
    rays.streams.push_back(r.next_u64());
    rays.samples.push_back(i % 4);
  }
  for (const Integrator* integrator : {static_cast<const Integrator*>(&path_integrator),
                                       static_cast<const Integrator*>(&fixed_integrator)}) {
    const auto scratch = integrator->make_scratch();
    RadianceBatch whole, part;
    Counters counters, part_counters;
    whole.reset(rays.size());
    integrator->radiance(rays, *scratch, whole, counters);
    for (size_t first = 0, n = 1; first < rays.size(); first += n, n = n * 2 + 1) {
      n = std::min(n, rays.size() - first);
      ViewingRays some;
      for (size_t i = first; i < first + n; ++i) {
        some.rays.push_back(rays.rays[i]);
        some.streams.push_back(rays.streams[i]);
        some.samples.push_back(rays.samples[i]);
      }
      part.reset(n);
      integrator->radiance(some, *scratch, part, part_counters);
      for (size_t i = 0; i < n; ++i) {
        REQUIRE(part.direct[i] == whole.direct[first + i]);
        REQUIRE(part.indirect[i] == whole.indirect[first + i]);
        REQUIRE(part.normal[i] == whole.normal[first + i]);
        REQUIRE(part.shadow_rays[i] == whole.shadow_rays[first + i]);
      }
    }
    CHECK(counters.shadow_rays == part_counters.shadow_rays);
    CHECK(counters.viewing_rays == part_counters.viewing_rays);
  }
}
