// Direct light against closed forms and quadrature, for both methods.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "light/irradiance.h"
#include "light/source_surface.h"
#include "probe.h"

using namespace troffer;
using namespace troffer::test;

namespace test_direct {

namespace {

struct NamedSource {
  std::string name;
  std::function<void(Scene&)> add;
};

// Sources of every kind above the floor z = 0, 1 to 3 m away.
std::vector<NamedSource> sources() {
  return {
      {"square", [](Scene& s) { add_ceiling_light(s, 1, 2, Rgb{5}); }},
      {"two-sided square seen from its back",
       [](Scene& s) {
         make_light(s, add_quad(s, 0, {Vec3{0, 0, 1}, {1, 0, 1}, {1, 1, 1.3f}, {0, 1, 1.3f}}),
                    Rgb{3}, true);
       }},
      {"wall that the floor's plane cuts",
       [](Scene& s) {
         make_light(s, add_quad(s, 0, {Vec3{1, -1, -1}, {1, -1, 1}, {1, 1, 1}, {1, 1, -1}}),
                    Rgb{2});
       }},
      {"sphere",
       [](Scene& s) {
         add_sphere_light(s, 0, {0.5f, 0, 1.5f}, 0.4f, Rgb{4});
       }},
      {"sphere cut by the floor's plane",
       [](Scene& s) {
         add_sphere_light(s, 0, {1.5f, 0, 0.1f}, 0.5f, Rgb{4});
       }},
      {"disk",
       [](Scene& s) {
         add_disk_light(s, 0, {-1, 0.5f, 2}, normalize(Vec3{0.4f, -0.3f, -1}), 0.6f, Rgb{4});
       }},
      {"folded mesh",
       [](Scene& s) {
         add_mesh_light(s, 0, {{-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 1.5f}},
                        {{0, 1, 2}, {0, 2, 3}}, Rgb{2}, false);
       }},
      {"many small ones",
       [](Scene& s) {
         for (int i = 0; i < 30; ++i) {
           const float x = float(i % 6) - 2.5f, y = float(i / 6) - 2;
           add_disk_light(s, 0, {x, y, 1.5f + 0.01f * float(i)}, {0, 0, -1}, 0.1f,
                          Rgb{float(1 + i * i)});
         }
       }},
  };
}

std::unique_ptr<Integrator> direct_path(const PreparedScene& scene) {
  PathOptions o;
  o.is_direct_only = true;
  return std::make_unique<PathIntegrator>(scene, o);
}
std::unique_ptr<Integrator> fixed(const PreparedScene& scene, int shadow_rays) {
  return std::make_unique<WaveIntegrator>(fixed_integrator(scene, shadow_rays));
}

void add_floor(Scene& s, uint32_t material) {
  add_quad(s, material, {Vec3{-20, -20, 0}, {20, -20, 0}, {20, 20, 0}, {-20, 20, 0}});
}

const Vec3 eye{-1.5f, 1, 1.2f};  // no source stands between it and the points
const std::vector<Vec3> targets{{0, -0.5f, 0}, {0.2f, -2, 0}, {-2, 2, 0}};

// Returns the radiance that leaves x towards the eye, by quadrature over every source's (u,v).
double by_quadrature(const PreparedScene& scene, const Vec3& x, uint32_t material, int cells) {
  const Ray ray = ray_towards(eye, x);
  Surface surface;
  surface.position = x;
  surface.geometric_normal = surface.shading_normal = {0, 0, 1};
  surface.material = material;
  const Vertex v = make_vertex(surface, ray.direction);
  const Bsdf bsdf = make_bsdf(scene.bsdf_tables, scene.scene, material, {}, true);
  double sum = 0;
  // Many sources are small ones.
  cells = std::max(cells / int(std::sqrt(double(scene.scene.lights.size()))), 32);
  for (uint32_t e = 0; e < scene.scene.lights.size(); ++e) {
    const Light& light = scene.scene.lights[e];
    const SourceSurface source(scene.scene, e);
    double part = 0;
    for (int i = 0; i < cells; ++i)
      for (int j = 0; j < cells; ++j) {
        const SourcePoint p =
            source.point_at({(float(i) + 0.5f) / float(cells), (float(j) + 0.5f) / float(cells)});
        const Vec3 to = p.point - x;
        const Vec3 wi = normalize(to);
        const float cos_source = -dot(wi, p.normal);
        if (wi.z <= 0 || (cos_source <= 0 && !light.is_two_sided)) continue;
        const Rgb radiance = emitted_radiance(scene.scene, light, cos_source > 0, p.texture_uv);
        const Rgb f_cos = evaluate(bsdf, v.wo, v.frame.to_local(wi));
        part += double(f_cos.g) * double(radiance.g) * double(std::abs(cos_source)) /
                double(length_squared(to));
      }
    sum += part * source.area() / (double(cells) * cells);
  }
  return sum;
}

}  // namespace

TEST_CASE("a matte floor shows reflectance × exact irradiance / pi") {
  const auto all = sources();
  const double significance = sidak(1e-3, int(all.size() * targets.size() * 3));
  for (const NamedSource& source : all) {
    Scene s;
    const uint32_t grey = add_diffuse(s, Rgb{0.7f, 0.6f, 0.5f});
    source.add(s);
    add_floor(s, grey);
    const PreparedScene scene(std::move(s));
    const auto path = direct_path(scene), one = fixed(scene, 1), many = fixed(scene, 16);
    for (const Vec3& x : targets) {
      double expected = 0;
      for (uint32_t e = 0; e < scene.scene.lights.size(); ++e)
        expected += irradiance(scene.primitives, e, Vec3d(x), {0, 0, 1}) *
                    double(scene.scene.lights[e].radiance.g) * double(0.6f) / pi;
      CAPTURE(source.name);
      CAPTURE(x.x);
      REQUIRE(expected > 1e-3);
      for (const Integrator* i : {path.get(), one.get(), many.get()}) {
        const bool is_many = i == many.get();
        const Probed p = probe(*i, ray_towards(eye, x), is_many ? 16 : 128, 24);
        CAPTURE(source.name);
        CAPTURE(x.x);
        CAPTURE(expected);
        CAPTURE(p.total.mean());
        CAPTURE(p.total.standard_error());
        CHECK(p_of_mean(p.total, expected, 2e-5 * expected) > significance);
        CHECK(p.indirect.mean() == 0);
      }
    }
  }
}

// An edge 10 cm above the point shows half a millimetre of a strip, and rays that end slightly off
// the strip would see a different half. The visible part is a narrow rectangle with a closed form.
TEST_CASE("a light strip of which an edge leaves half a millimetre visible") {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  make_light(s, add_quad(s, grey, {Vec3{0, -5, 0}, {0.06f, -5, 0}, {0.06f, 5, 0}, {0, 5, 0}}),
             Rgb{100});
  // From the ceiling's point (1, 0, 0.5), the edge at (x, 0, 0.1) shows what is right of .0595.
  const float edge = 0.0595f + 0.2f * (1 - 0.0595f);
  add_quad(s, grey, {Vec3{-0.5f, -9, 0.1f}, {edge, -9, 0.1f}, {edge, 9, 0.1f}, {-0.5f, 9, 0.1f}});
  Scene seen;
  add_diffuse(seen, Rgb{0.5f});
  make_light(
      seen,
      add_quad(seen, grey, {Vec3{0.0595f, -5, 0}, {0.06f, -5, 0}, {0.06f, 5, 0}, {0.0595f, 5, 0}}),
      Rgb{100});
  const PreparedScene narrow(std::move(seen));
  const double expected =
      irradiance(narrow.primitives, 0, {1, 0, 0.5}, {0, 0, -1}) * 100 * 0.5 / pi;
  add_quad(s, grey, {Vec3{0.8f, -1, 0.5f}, {0.8f, 1, 0.5f}, {1.2f, 1, 0.5f}, {1.2f, -1, 0.5f}});
  const PreparedScene scene(std::move(s));
  const Ray ray = ray_towards({1.2f, 0.1f, 0.2f}, {1, 0, 0.5f});
  const std::unique_ptr<Integrator> path = direct_path(scene), rays = fixed(scene, 256);
  const WaveIntegrator certified = certified_integrator(scene);
  const std::array<const Integrator*, 3> all{path.get(), rays.get(), &certified};
  for (const Integrator* i : all) {
    const Probed p = probe(*i, ray, i == path.get() ? 2048 : 64, 64);
    CAPTURE(expected);
    CAPTURE(p.total.mean());
    CAPTURE(p.total.standard_error());
    CHECK(std::abs(p.total.mean() - expected) < 4 * p.total.standard_error() + 0.01 * expected);
    CHECK(p.total.standard_error() < 0.02 * expected);
  }
}

TEST_CASE("glossy floors: the weights of light and gloss sampling add up to one") {
  const auto all = sources();
  const std::vector<float> roughnesses{0.1f, 0.4f};
  const double significance = sidak(1e-3, int(all.size() * targets.size() * 3 * 2));
  for (const NamedSource& source : all)
    for (const float roughness : roughnesses) {
      Scene s;
      Material m;
      m.kind = roughness < 0.2f ? MaterialKind::coated_diffuse : MaterialKind::conductor;
      m.base_color.value = Rgb{0.6f};
      m.is_reflectance = true;
      m.roughness.value = roughness;
      const uint32_t glossy = add_material(s, m);
      source.add(s);
      add_floor(s, glossy);
      const PreparedScene scene(std::move(s));
      const auto path = direct_path(scene), one = fixed(scene, 1), many = fixed(scene, 8);
      for (const Vec3& x : targets) {
        const double expected = by_quadrature(scene, x, glossy, 250);
        for (const Integrator* i : {path.get(), one.get(), many.get()}) {
          const Probed p = probe(*i, ray_towards(eye, x), i == many.get() ? 32 : 128, 32);
          CAPTURE(source.name);
          CAPTURE(roughness);
          CAPTURE(x.x);
          CAPTURE(expected);
          CAPTURE(p.total.mean());
          CAPTURE(p.total.standard_error());
          CHECK(p_of_mean(p.total, expected, 1e-3 * expected) > significance);
        }
      }
    }
}

TEST_CASE("a textured mesh source over a glossy floor") {
  Scene s;
  Material m;
  m.kind = MaterialKind::coated_diffuse;
  m.base_color.value = Rgb{0.5f};
  m.roughness.value = 0.2f;
  const uint32_t glossy = add_material(s, m);
  Texture t;
  t.kind = TextureKind::image;
  t.width = t.height = 2;
  t.channels = 1;
  t.texels_float = {0, 1, 2, 5};
  t.is_filtered = false;
  t.wrap_u = t.wrap_v = WrapMode::clamp;
  s.textures.push_back(t);
  add_mesh_light(s, glossy, {{-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 2}},
                 {{0, 1, 2}, {0, 2, 3}}, Rgb{2}, false);
  s.meshes.back().uvs = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
  s.lights.back().texture = 0;
  add_floor(s, glossy);
  const PreparedScene scene(std::move(s));
  const auto path = direct_path(scene), many = fixed(scene, 8);
  for (const Vec3& x : targets) {
    const double expected = by_quadrature(scene, x, glossy, 400);
    for (const Integrator* i : {path.get(), many.get()}) {
      const Probed p = probe(*i, ray_towards(eye, x), i == many.get() ? 32 : 256, 32);
      CAPTURE(x.x);
      CAPTURE(expected);
      CAPTURE(p.total.mean());
      CHECK(p_of_mean(p.total, expected, 2e-3 * expected) > sidak(1e-3, 6));
    }
  }
}

TEST_CASE("an alpha-masked sheet lets through what its mask does not cover") {
  // The left half of the sheet is a hole. A small source straight above lights x < 0 fully and x >
  // 0 not at all.
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.6f});
  Texture t;
  t.kind = TextureKind::image;
  t.width = 2;
  t.height = 1;
  t.channels = 4;
  t.texels8 = {255, 255, 255, 0, 255, 255, 255, 255};
  t.is_filtered = false;
  s.textures.push_back(t);
  Material masked;
  masked.is_alpha_masked = true;
  masked.alpha.texture = 0;
  const uint32_t mask = add_material(s, masked);
  add_quad(s, mask, {Vec3{-3, -3, 1}, {3, -3, 1}, {3, 3, 1}, {-3, 3, 1}});
  s.meshes.back().uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  add_ceiling_light(s, 0.1f, 2, Rgb{100});
  add_floor(s, grey);
  const PreparedScene scene(std::move(s));
  const auto path = direct_path(scene), many = fixed(scene, 4);
  for (const float x : {-1.0f, 1.0f}) {
    const Vec3 at{x, 0.5f, 0};
    const double e = 100 * irradiance(scene.primitives, 0, Vec3d(at), {0, 0, 1});
    for (const Integrator* i : {path.get(), many.get()}) {
      const Probed p = probe(*i, ray_towards({x, 0.4f, 0.5f}, at), 64, 16);
      const double expected = x < 0 ? double(0.6f) * e / pi : 0;
      CHECK(p_of_mean(p.total, expected, 1e-4 * expected) > 1e-4);
    }
  }
}

TEST_CASE("fixed sends the requested number of shadow rays") {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.6f});
  add_ceiling_light(s, 1, 2, Rgb{5});
  add_disk_light(s, 0, {1, 0, 2}, {0, 0, -1}, 0.2f, Rgb{1});
  add_floor(s, grey);
  const PreparedScene scene(std::move(s));
  const auto i = fixed(scene, 7);
  RadianceBatch out;
  Counters counters;
  const ViewingRays rays = repeated(ray_towards(eye, {0, 0, 0}), 1, 10);
  out.reset(rays.size());
  i->radiance(rays, *i->make_scratch(), out, counters);
  CHECK(counters.viewing_rays == 10);
  CHECK(counters.shadow_rays == 10 * 2 * 7);
  for (const uint32_t n : out.shadow_rays) CHECK(n == 14);
}

}  // namespace test_direct
