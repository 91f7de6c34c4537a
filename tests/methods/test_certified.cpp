// The certified integrator against closed forms and against fixed sampling.
#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "light/irradiance.h"
#include "probe.h"

using namespace troffer;
using namespace troffer::test;

namespace {

struct NamedScene {
  std::string name;
  std::function<void(Scene&)> build;
};

void add_floor(Scene& s, uint32_t material) {
  add_quad(s, material, {Vec3{-20, -20, 0}, {20, -20, 0}, {20, 20, 0}, {-20, 20, 0}});
}

// Adds a tilted square source that shines both ways, above the floor.
void add_two_sided(Scene& s) {
  make_light(s, add_quad(s, 0, {Vec3{0, 0, 1}, {1, 0, 1}, {1, 1, 1.3f}, {0, 1, 1.3f}}), Rgb{3},
             true);
}

void add_textured(Scene& s) {
  Texture t;
  t.kind = TextureKind::image;
  t.width = t.height = 2;
  t.channels = 1;
  t.texels_float = {0, 1, 2, 5};
  t.is_filtered = false;
  t.wrap_u = t.wrap_v = WrapMode::clamp;
  s.textures.push_back(t);
  add_mesh_light(s, 0, {{-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 2}}, {{0, 1, 2}, {0, 2, 3}},
                 Rgb{2}, false);
  s.meshes.back().uvs = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
  s.lights.back().texture = 0;
}

const Vec3 eye{-1.5f, 1, 1.2f};  // no source stands between it and the points
const std::vector<Vec3> targets{{0, -0.5f, 0}, {0.2f, -2, 0}, {-2, 2, 0}};

// Checks that both methods see the same at points of `scene`, from the eye.
void check_against_fixed(const PreparedScene& scene, const std::vector<Vec3>& points, double error,
                         double significance) {
  const WaveIntegrator mine = certified_integrator(scene, error);
  const WaveIntegrator fixed = fixed_integrator(scene, 256);
  for (const Vec3& x : points) {
    const Probed a = probe(mine, ray_towards(eye, x), 64, 24);
    const Probed b = probe(fixed, ray_towards(eye, x), 4, 24, 77);
    CAPTURE(x.x);
    CAPTURE(x.y);
    CAPTURE(a.total.mean());
    CAPTURE(a.total.standard_error());
    CAPTURE(b.total.mean());
    CAPTURE(b.total.standard_error());
    CHECK(p_of_difference(a.total, b.total, 5e-5 * b.total.mean()) > significance);
  }
}

}  // namespace

TEST_CASE("certified: unoccluded light of a flat source is exact, and no ray is cast") {
  const std::vector<NamedScene> scenes{
      {"square", [](Scene& s) { add_ceiling_light(s, 1, 2, Rgb{5}); }},
      {"two-sided square seen from its back", add_two_sided},
      {"wall that the floor's plane cuts",
       [](Scene& s) {
         make_light(s, add_quad(s, 0, {Vec3{1, -1, -1}, {1, -1, 1}, {1, 1, 1}, {1, 1, -1}}),
                    Rgb{2});
       }},
      {"folded mesh",
       [](Scene& s) {
         add_mesh_light(s, 0, {{-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 1.5f}},
                        {{0, 1, 2}, {0, 2, 3}}, Rgb{2}, false);
       }},
  };
  for (const NamedScene& source : scenes) {
    Scene s;
    const uint32_t grey = add_diffuse(s, Rgb{0.7f, 0.6f, 0.5f});
    source.build(s);
    add_floor(s, grey);
    const PreparedScene scene(std::move(s));
    const WaveIntegrator mine = certified_integrator(scene);
    for (const Vec3& x : targets) {
      double expected = 0;
      for (uint32_t e = 0; e < scene.scene.lights.size(); ++e)
        expected += irradiance(scene.primitives, e, Vec3d(x), {0, 0, 1}) *
                    double(scene.scene.lights[e].radiance.g) * double(0.6f) / pi;
      RadianceBatch out;
      Counters counters;
      const ViewingRays rays = repeated(ray_towards(eye, x), 1, 10);
      out.reset(rays.size());
      mine.radiance(rays, *mine.make_scratch(), out, counters);
      CAPTURE(source.name);
      CAPTURE(x.x);
      for (const Rgb& radiance : out.direct)
        CHECK(double(radiance.g) == doctest::Approx(expected).epsilon(2e-5));
      CHECK(counters.shadow_rays == 0);
      // Each triangle of a folded mesh may hide the other.
      if (scene.primitives.size() > 1) continue;
      CHECK(counters.lit_certified == 10);
      CHECK(counters.masked + counters.mixed + counters.dark_certified == 0);
    }
  }
}

TEST_CASE("certified: sources without certificates are sampled by rays, without bias") {
  const std::vector<NamedScene> scenes{
      {"sphere",
       [](Scene& s) {
         add_sphere_light(s, 0, {0.5f, 0, 1.5f}, 0.4f, Rgb{4});
       }},
      {"disk",
       [](Scene& s) {
         add_disk_light(s, 0, {-1, 0.5f, 2}, normalize(Vec3{0.4f, -0.3f, -1}), 0.6f, Rgb{4});
       }},
      {"textured", add_textured},
      {"sphere and square",
       [](Scene& s) {
         add_sphere_light(s, 0, {1.5f, 0, 1.5f}, 0.3f, Rgb{4});
         add_ceiling_light(s, 1, 2, Rgb{5});
       }},
  };
  for (const NamedScene& source : scenes) {
    Scene s;
    const uint32_t grey = add_diffuse(s, Rgb{0.6f});
    source.build(s);
    add_floor(s, grey);
    CAPTURE(source.name);
    check_against_fixed(PreparedScene(std::move(s)), targets, 0.01,
                        sidak(1e-3, int(scenes.size() * targets.size())));
  }
}

TEST_CASE("certified: penumbrae agree with fixed sampling") {
  const auto add_table = [](Scene& s) {
    add_block(s, 0, {-0.6f, -0.7f, 0.7f}, {0.6f, 0.3f, 0.75f});
  };
  const std::vector<NamedScene> scenes{
      {"table",
       [&](Scene& s) {
         add_ceiling_light(s, 1, 2, Rgb{5});
         add_table(s);
       }},
      {"sheets that cross each other, the floor and the source's plane",
       [](Scene& s) {
         add_ceiling_light(s, 1.5f, 2, Rgb{5});
         add_quad(s, 0, {Vec3{0.1f, -3, -1}, {0.3f, -3, 3}, {0.3f, 3, 3}, {0.1f, 3, -1}});
         add_quad(s, 0, {Vec3{-3, 0.2f, 0.5f}, {3, 0.1f, 0.5f}, {3, 0.1f, 1.5f}, {-3, 0.2f, 1}});
       }},
      {"source set into a ceiling, under a lattice of bars",
       [](Scene& s) {
         add_quad(s, 0, {Vec3{-4, -4, 2}, {-4, 4, 2}, {4, 4, 2}, {4, -4, 2}});
         add_ceiling_light(s, 1, 2, Rgb{5});
         for (int i = 0; i < 6; ++i) {
           const float x = -0.55f + 0.2f * float(i);
           add_quad(s, 0,
                    {Vec3{x, -2, 1.8f}, {x + 0.03f, -2, 1.8f}, {x + 0.03f, 2, 1.8f}, {x, 2, 1.8f}});
         }
       }},
      {"a ball before a two-sided source and a square",
       [](Scene& s) {
         add_two_sided(s);
         add_ceiling_light(s, 1, 2, Rgb{5});
         s.spheres.push_back({{0, -0.4f, 0.8f}, 0.3f, false, 0, no_light});
       }},
      {"a leaf, which only rays meet, before a two-sided source and a square",
       [](Scene& s) {
         add_two_sided(s);
         add_ceiling_light(s, 1, 2, Rgb{5});
         add_leaf(s, {Vec3{-0.3f, -0.7f, 0.8f},
                      {0.3f, -0.7f, 0.7f},
                      {0.3f, -0.1f, 0.7f},
                      {-0.3f, -0.1f, 0.8f}});
       }},
  };
  const std::vector<Vec3> points{{0, -0.5f, 0}, {-0.7f, -0.6f, 0}, {0.8f, -0.9f, 0}};
  for (const NamedScene& scene : scenes)
    for (const double error : {0.01, 0.002}) {
      Scene s;
      const uint32_t grey = add_diffuse(s, Rgb{0.6f});
      scene.build(s);
      add_floor(s, grey);
      CAPTURE(scene.name);
      CAPTURE(error);
      check_against_fixed(PreparedScene(std::move(s)), points, error,
                          sidak(1e-3, int(scenes.size() * points.size() * 2)));
    }
}

TEST_CASE("certified: coats, gloss and mirrors agree with fixed sampling") {
  for (const float roughness : {0.0f, 0.1f, 0.4f})
    for (const MaterialKind kind : {MaterialKind::coated_diffuse, MaterialKind::conductor}) {
      Scene s;
      Material m;
      m.kind = kind;
      m.base_color.value = Rgb{0.6f};
      m.is_reflectance = true;
      m.roughness.value = roughness;
      add_diffuse(s, Rgb{0.5f});
      const uint32_t glossy = add_material(s, m);
      add_ceiling_light(s, 1, 2, Rgb{5});
      add_two_sided(s);
      add_block(s, 0, {-0.4f, -0.7f, 0.7f}, {0.6f, -0.3f, 0.75f});
      add_floor(s, glossy);
      CAPTURE(roughness);
      CAPTURE(int(kind));
      check_against_fixed(PreparedScene(std::move(s)), targets, 0.01, sidak(1e-3, 18));
    }
}

TEST_CASE("certified: earlier use of a scratch has no effect") {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.6f});
  add_ceiling_light(s, 1, 2, Rgb{5});
  add_leaf(s, {Vec3{-0.3f, -1.2f, 0.8f},
               {0.1f, -1.2f, 0.8f},
               {0.1f, -0.1f, 0.8f},
               {-0.3f, -0.1f, 0.8f}});  // makes rays necessary
  add_block(s, grey, {-0.6f, -0.7f, 0.7f}, {0.6f, 0.3f, 0.75f});
  add_floor(s, grey);
  const PreparedScene scene(std::move(s));
  const WaveIntegrator mine = certified_integrator(scene);
  const auto used = mine.make_scratch(), fresh = mine.make_scratch();
  RadianceBatch first, second;
  Counters counters, more;
  const ViewingRays before = repeated(ray_towards(eye, {-0.1f, -0.9f, 0}), 5, 50);
  first.reset(before.size());
  mine.radiance(before, *used, first, counters);
  CHECK(counters.shadow_rays > 0);
  const ViewingRays rays = repeated(ray_towards(eye, {0.1f, -0.9f, 0}), 3, 50);
  first.reset(rays.size());
  second.reset(rays.size());
  mine.radiance(rays, *used, first, counters);
  mine.radiance(rays, *fresh, second, more);
  for (size_t i = 0; i < rays.size(); ++i) CHECK(first.direct[i].g == second.direct[i].g);
}

TEST_CASE(
    "certified: irradiance at points is exact in the open and agrees with fixed under a table") {
  Scene s;
  add_diffuse(s, Rgb{0.6f});
  add_ceiling_light(s, 1, 2, Rgb{5});
  add_block(s, 0, {-0.6f, -0.7f, 0.7f}, {0.6f, 0.3f, 0.75f});
  const PreparedScene scene(std::move(s));
  const WaveIntegrator mine = certified_integrator(scene);
  const WaveIntegrator fixed = fixed_integrator(scene, 256);
  for (const Vec3& x : {Vec3{5, 1, 0}, Vec3{0.9f, 0, 0}}) {
    Moments a, b;
    for (uint64_t set = 0; set < 24; ++set) {
      SensorBatch sensors;
      sensors.positions.assign(16, x);
      sensors.normals.assign(16, {0, 0, 1});
      sensors.streams.assign(16, hash_of(set));
      for (uint32_t i = 0; i < 16; ++i) sensors.samples.push_back(i);
      sensors.offset = 1e-5f;
      for (const Integrator* method :
           {static_cast<const Integrator*>(&mine), static_cast<const Integrator*>(&fixed)}) {
        RadianceBatch out;
        Counters counters;
        out.reset(16);
        method->irradiance(sensors, *method->make_scratch(), out, counters);
        double sum = 0;
        for (const Rgb& e : out.direct) sum += double(e.g) / 16;
        (method == &mine ? a : b).add(sum);
      }
    }
    CAPTURE(x.x);
    if (x.x == 5)
      CHECK(
          a.mean() ==
          doctest::Approx(5 * irradiance(scene.primitives, 0, Vec3d(x), {0, 0, 1})).epsilon(2e-5));
    CHECK(p_of_difference(a, b, 5e-5 * b.mean()) > 1e-4);
  }
}

TEST_CASE("certified: with many sources, steps of one normal lose no source between them") {
  Scene s;
  add_diffuse(s, Rgb{0.6f});
  for (int i = 0; i < 30; ++i) {  // upright, in a row, at heights between those of the points
    const float y = 0.4f * float(i) - 6;
    make_light(
        s,
        add_quad(s, 0, {Vec3{3, y, 0.2f}, {3, y, 0.4f}, {3, y + 0.2f, 0.4f}, {3, y + 0.2f, 0.2f}}),
        Rgb{5});
  }
  add_block(s, 0, {20, -20, -1}, {21, 20, 0});  // makes the scene and the clusters wide
  const PreparedScene scene(std::move(s));
  const WaveIntegrator mine = certified_integrator(scene);
  SensorBatch sensors;
  sensors.positions = {{0, 0, 0}, {0, 0, 1}};
  sensors.normals.assign(2, {0, 0, 1});
  sensors.streams = {hash_of(1u), hash_of(2u)};
  sensors.samples = {0, 0};
  sensors.offset = 1e-5f;
  RadianceBatch out;
  Counters counters;
  out.reset(2);
  mine.irradiance(sensors, *mine.make_scratch(), out, counters);
  double expected = 0;
  for (uint32_t e = 0; e < scene.scene.lights.size(); ++e)
    expected += 5 * irradiance(scene.primitives, e, {0, 0, 0}, {0, 0, 1});
  REQUIRE(expected > 0);
  CHECK(double(out.direct[0].g) == doctest::Approx(expected).epsilon(1e-4));
  CHECK(out.direct[1].g == 0);
}

TEST_CASE("certified: a point on a polygon of many corners belongs to one of its parts") {
  Scene s;
  add_diffuse(s, Rgb{0.6f});
  // A square under an arc. The second of the fan's two parts is the square.
  std::vector<Vec3> outline{{0, 0, 2}};
  for (int i = 1; i < 10; ++i)
    outline.push_back({0.1f * float(i), -0.3f * std::sin(pi_f * 0.1f * float(i)), 2});
  outline.insert(outline.end(), {{1, 0, 2}, {1, 1, 2}, {0, 1, 2}});
  const uint32_t mesh = add_quad(s, 0, {Vec3{0, 0, 2}, {1, 0, 2}, {1, 1, 2}, {0, 1, 2}});
  s.meshes[mesh].positions = outline;
  s.meshes[mesh].triangles.clear();
  for (uint32_t i = 1; i + 1 < outline.size(); ++i)
    s.meshes[mesh].triangles.push_back({0, i, i + 1});
  make_light(s, mesh, Rgb{5});
  const size_t triangles = s.meshes[mesh].triangles.size();
  s.meshes[mesh].lights.assign(triangles, 0);
  for (uint32_t t = 2; t < triangles; ++t) s.lights[0].triangles.push_back(t);
  const PreparedScene scene(std::move(s));
  const CertifiedSources lights(scene, false, 32);
  REQUIRE(lights.has(0));
  const CertifiedSource* square = lights.source_of(0, false, {0.5f, 0.5f, 2});
  const CertifiedSource* arc = lights.source_of(0, false, {0.5f, -0.15f, 2});
  REQUIRE(square != nullptr);
  REQUIRE(arc != nullptr);
  CHECK(square->flat.outline.empty());
  CHECK(arc->flat.outline.size() == 11);
}

TEST_CASE("certified: a leaf causes rays only where it may hide a source") {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.6f});
  add_ceiling_light(s, 1, 2, Rgb{5});
  add_leaf(s, {Vec3{-0.01f, -0.7f, 0.8f},
               {0.01f, -0.7f, 0.8f},
               {0.01f, -0.1f, 0.8f},
               {-0.01f, -0.1f, 0.8f}});
  add_floor(s, grey);
  const PreparedScene scene(std::move(s));
  const WaveIntegrator mine = certified_integrator(scene);
  const auto rays_at = [&](const Vec3& x) {
    RadianceBatch out;
    Counters counters;
    const ViewingRays rays = repeated(ray_towards(eye, x), 3, 64);
    out.reset(rays.size());
    mine.radiance(rays, *mine.make_scratch(), out, counters);
    return double(counters.shadow_rays) / 64;
  };
  const double under = rays_at({0, -0.6f, 0}), beside = rays_at({1.5f, -0.6f, 0});
  MESSAGE(under, " rays under the leaf, ", beside, " beside it");
  CHECK(under > 0);
  CHECK(under < 20);  // with all lights open it would be 256
  CHECK(beside == 0);
}
