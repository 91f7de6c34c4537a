// The method of 1992, ray by ray, against closed forms and against the other methods.
#include "kj92/bintree_direct.h"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "kj92/radiosity_indirect.h"
#include "light/irradiance.h"
#include "light/source_surface.h"
#include "probe.h"
#include "radiosity/solver.h"

using namespace troffer;
using namespace troffer::test;

namespace test_kj92 {

namespace {

struct Kj92Options {
  TreeSamplingOptions sampling;
  bool is_direct_only = false;  // only light straight from lights
};

struct Setting {
  Kj92Options options;
  SelectionOptions selection;
  RadiosityOptions radiosity;

  Setting() {
    radiosity.meshing.element_size = 0.5f;
    radiosity.meshing.patch_size = 2;
    radiosity.unshot_fraction = 0.02f;
  }
  static Setting direct(bool has_selection = true) {
    Setting s;
    s.options.is_direct_only = true;
    s.radiosity.unshot_fraction = 1;
    s.selection.uses_patches = false;
    s.selection.is_enabled = has_selection;
    return s;
  }
  // Turns off all stops but the cap: full stratified sampling.
  Setting& full(int rays) {
    options.sampling.tree.allowed_variance = 0;
    options.sampling.tree.most_rays = rays;
    return *this;
  }
};

// The method with everything that it needs.
struct Kj92 {
  Kj92(Scene s, const Setting& setting)
      : scene(std::move(s)),
        solution(solve_radiosity(scene.scene, scene.tracer, scene.bsdf_tables, scene.primitives,
                                 setting.radiosity, 2, {}, StopFlag{false})),
        selection(solution, scene.tracer, scene.primitives, setting.selection, 2, StopFlag{false}),
        integrator(make(setting)) {}
  const PreparedScene scene;
  const RadiositySolution solution;
  const SourceSelection selection;
  const WaveIntegrator integrator;

 private:
  WaveIntegrator make(const Setting& setting) const {
    const RadiosityLight radiosity(scene, solution, selection);
    std::unique_ptr<IndirectLight> indirect;
    if (!setting.options.is_direct_only)
      indirect = std::make_unique<RadiosityIndirect>(scene, radiosity);
    return {scene, std::make_unique<BintreeDirect>(scene, radiosity, setting.options.sampling),
            std::move(indirect)};
  }
};

struct NamedSource {
  std::string name;
  std::function<void(Scene&)> add;
};

void add_texture(Scene& s, std::vector<float> texels) {
  Texture t;
  t.kind = TextureKind::image;
  t.width = int(texels.size());
  t.height = t.channels = 1;
  t.texels_float = std::move(texels);
  t.is_srgb = t.is_filtered = false;
  t.wrap_u = t.wrap_v = WrapMode::clamp;
  s.textures.push_back(t);
}

std::vector<NamedSource> sources() {
  const auto sheet = [](Scene& s, uint32_t material) {
    add_mesh_light(s, material, {{-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 2}},
                   {{0, 1, 2}, {0, 2, 3}}, Rgb{2}, false);
    s.meshes.back().uvs = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
  };
  return {
      {"square", [](Scene& s) { add_ceiling_light(s, 1, 2, Rgb{5}); }},
      {"pentagon",
       [](Scene& s) {
         Mesh m;
         m.positions = {
             {-0.5f, -0.5f, 2}, {-0.7f, 0.3f, 2}, {0, 0.8f, 2}, {0.7f, 0.3f, 2}, {0.5f, -0.5f, 2}};
         m.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}};
         s.meshes.push_back(m);
         make_light(s, uint32_t(s.meshes.size() - 1), Rgb{4});
         s.lights.back().triangles = {0, 1, 2};
         s.meshes.back().lights.assign(3, int32_t(s.lights.size()) - 1);
       }},
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
      {"textured mesh",
       [sheet](Scene& s) {
         add_texture(s, {0, 1, 2, 5});
         sheet(s, 0);
         s.lights.back().texture = 0;
       }},
      {"mesh with holes",
       [sheet](Scene& s) {
         add_texture(s, {0, 1, 1, 0});
         Material m;
         m.is_alpha_masked = true;
         m.alpha = {1, 0, 0};
         sheet(s, add_material(s, m));
         s.lights.back().is_alpha_masked = true;
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

void add_floor(Scene& s, uint32_t material) {
  add_quad(s, material, {Vec3{-6, -6, 0}, {6, -6, 0}, {6, 6, 0}, {-6, 6, 0}});
}

const Vec3 eye{-1.5f, 1, 1.2f};  // no source stands between it and the points
const std::vector<Vec3> targets{{0, -0.5f, 0}, {0.2f, -2, 0}, {-2, 2, 0}};

// Returns the irradiance of an upward receiver from all sources, by quadrature over their (u,v).
// is_open: tells which points of sources the receiver sees; empty: all.
double by_quadrature(const PreparedScene& scene, const Vec3& x, int cells,
                     const std::function<bool(const Vec3&)>& is_open = {}) {
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
        if (is_open && !is_open(p.point)) continue;
        const Vec3 to = p.point - x, wi = normalize(to);
        const float cos_source = -dot(wi, p.normal);
        if (wi.z <= 0 || (cos_source <= 0 && !light.is_two_sided)) continue;
        const Rgb radiance = emitted_radiance(scene.scene, light, cos_source > 0, p.texture_uv);
        part += double(wi.z) * double(radiance.g) * double(std::abs(cos_source)) /
                double(length_squared(to));
      }
    sum += part * source.area() / (double(cells) * cells);
  }
  return sum;
}

}  // namespace

TEST_CASE("open sources of every shape: a matte floor shows reflectance × irradiance / pi") {
  for (const NamedSource& source : sources())
    for (const bool has_selection : {true, false}) {
      Scene s;
      const uint32_t grey = add_diffuse(s, Rgb{0.7f, 0.6f, 0.5f});
      source.add(s);
      add_floor(s, grey);
      const Kj92 kj(std::move(s), Setting::direct(has_selection));
      for (const Vec3& x : targets) {
        const double expected = by_quadrature(kj.scene, x, 200) * double(0.6f) / pi;
        CAPTURE(source.name);
        CAPTURE(has_selection);
        CAPTURE(x.x);
        REQUIRE(expected > 1e-3);
        const Probed p = probe(kj.integrator, ray_towards(eye, x), 16, 16);
        CAPTURE(expected);
        CAPTURE(p.total.mean());
        CAPTURE(p.total.standard_error());
        // Selection leaves weak sources to the interpolated general radiosity, and an adaptive tree
        // has a small bias.
        CHECK(std::abs(p.total.mean() - expected) < 4 * p.total.standard_error() + 0.01 * expected);
        CHECK(p.indirect.mean() == 0);
      }
    }
}

TEST_CASE("a source half hidden by an edge has the expected bias") {
  // The edge of a screen cuts the square source as seen from x, at `cut` of its width.
  double worst = 0;
  std::string table;
  for (const float cut : {-0.4f, -0.15f, 0.0f, 0.03f, 0.3f, 0.45f})
    for (const float slope : {0.0f, 0.4f}) {
      Scene s;
      const uint32_t grey = add_diffuse(s, Rgb{0.5f});
      add_ceiling_light(s, 1, 2, Rgb{5});
      // The screen lies halfway: its edge runs through (cut/2, 0, 1) as seen from the origin.
      const Vec3 along = normalize(Vec3{slope, 1, 0}) * 3, across = Vec3{along.y, -along.x, 0};
      const Vec3 on{cut / 2, 0, 1};
      add_quad(s, grey, {on - along, on - along + across, on + along + across, on + along});
      add_floor(s, grey);
      const auto is_open = [&](const Vec3& y) {  // point of the light, seen from the origin
        return dot(y * 0.5f - on, normalize(across)) < 0;
      };
      const PreparedScene prepared(s);
      const double expected = by_quadrature(prepared, {}, 500, is_open) * 0.5 / pi;
      const double open = by_quadrature(prepared, {}, 200) * 0.5 / pi;
      for (const bool has_coherence : {false, true}) {
        Setting setting = Setting::direct(false);
        setting.options.sampling.has_coherence = has_coherence;
        const Kj92 kj(s, setting);
        const Probed p = probe(kj.integrator, ray_towards({-1, 0.3f, 0.4f}, {}), 32, 24);
        const double bias = (p.total.mean() - expected) / open;
        worst = std::max(worst, std::abs(bias));
        char line[160];
        std::snprintf(line, sizeof line,
                      "cut %+.2f slope %.1f coherence %d: seen %.3f bias %+.4f ± %.4f of open\n",
                      double(cut), double(slope), has_coherence, expected / open, bias,
                      p.total.standard_error() / open);
        table += line;
        // If the first rays all fall on one side of the edge, a tree without coherence stops at
        // once.
        CHECK(std::abs(bias) < (has_coherence ? 0.005 : 0.05));
      }
    }
  MESSAGE(table << "largest bias " << worst);
}

TEST_CASE("allowed variance 0 with a cap is full stratified sampling without bias") {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  add_ceiling_light(s, 1, 2, Rgb{5});
  add_quad(s, grey, {Vec3{0.1f, -3, 1}, {3, -3, 1}, {3, 3, 1}, {0.1f, 3, 1}});
  add_floor(s, grey);
  for (const int rays : {16, 64, 256}) {
    const Kj92 kj(s, Setting::direct(false).full(rays));
    RadianceBatch out;
    Counters counters;
    const ViewingRays batch = repeated(ray_towards({-1, 0.3f, 0.4f}, {}), 1, 20);
    out.reset(batch.size());
    kj.integrator.radiance(batch, *kj.integrator.make_scratch(), out, counters);
    CHECK(counters.shadow_rays == uint64_t(20 * rays));
    const double expected =
        by_quadrature(kj.scene, {}, 800, [](const Vec3& y) { return y.x < 0.2f; }) * 0.5 / pi;
    const Probed p = probe(kj.integrator, ray_towards({-1, 0.3f, 0.4f}, {}), 16, 60);
    CAPTURE(rays);
    CAPTURE(expected);
    CAPTURE(p.total.mean());
    CHECK(p_of_mean(p.total, expected, 5e-4 * expected) > 1e-4);
  }
}

TEST_CASE("ratio estimate: unoccluded light is exact, half-hidden light is unbiased") {
  Setting setting = Setting::direct(false);
  setting.options.sampling.uses_ratio = true;
  Scene open;
  const uint32_t grey = add_diffuse(open, Rgb{0.5f});
  // A large source close by: values of its rays differ greatly.
  make_light(
      open,
      add_quad(open, grey, {Vec3{-1, -1, 0.05f}, {-1, 1, 0.05f}, {1, 1, 0.05f}, {1, -1, 0.05f}}),
      Rgb{5});
  add_floor(open, grey);
  const Ray ray = ray_towards({-1.5f, 0, 0.03f}, {-0.9f, 0, 0});
  const Kj92 near(open, setting);
  const double expected = irradiance(near.scene.primitives, 0, Vec3d{-0.9, 0, 0}, Vec3d{0, 0, 1}) *
                          5 * 0.5 / double(pi);
  const Probed exact = probe(near.integrator, ray, 1, 20);
  CHECK(exact.total.mean() == doctest::Approx(expected).epsilon(1e-4));
  CHECK(exact.total.variance_of_mean() < 1e-8 * expected * expected);

  Scene half;
  const uint32_t floor = add_diffuse(half, Rgb{0.5f});
  add_ceiling_light(half, 1, 2, Rgb{5});
  add_quad(half, floor, {Vec3{0.1f, -3, 1}, {3, -3, 1}, {3, 3, 1}, {0.1f, 3, 1}});
  add_floor(half, floor);
  const Kj92 hidden(half, setting);
  const double share =
      by_quadrature(hidden.scene, {}, 800, [](const Vec3& y) { return y.x < 0.2f; }) * 0.5 / pi;
  const Probed p = probe(hidden.integrator, ray_towards({-1, 0.3f, 0.4f}, {}), 16, 60);
  CHECK(p.total.mean() == doctest::Approx(share).epsilon(0.05));  // biased by design
}

TEST_CASE("direct light only: agrees with the fixed method on surfaces of every kind") {
  struct Named {
    std::string name;
    Material material;
  };
  std::vector<Named> all;
  const auto add = [&](const std::string& name, MaterialKind kind, float roughness) {
    Material m;
    m.kind = kind;
    m.is_reflectance = true;
    m.base_color.value = Rgb{0.6f};
    m.roughness.value = roughness;
    m.metallic.value = 0.5f;
    all.push_back({name, m});
  };
  for (const float r : {0.0f, 0.1f, 0.4f}) {
    add("coated", MaterialKind::coated_diffuse, r);
    add("metal", MaterialKind::conductor, r);
    add("glTF", MaterialKind::metallic_roughness, r);
  }
  add("rough glass", MaterialKind::dielectric, 0.3f);
  add("clear glass", MaterialKind::dielectric, 0);
  const std::vector<NamedSource> lights = sources();
  const double significance = sidak(1e-3, int(all.size() * 3 * 2));
  for (const Named& named : all)
    for (const size_t light : {0u, 4u, 8u}) {
      Scene s;
      const uint32_t glossy = add_material(s, named.material);
      const uint32_t white = add_diffuse(s, Rgb{0.7f});
      lights[light].add(s);
      add_floor(s, glossy);
      // A shelf hides a part of the light, and the floor mirrors it.
      add_quad(s, white, {Vec3{0.2f, -3, 1}, {1.4f, -3, 1}, {1.4f, 3, 1}, {0.2f, 3, 1}});
      const Kj92 kj(s, Setting::direct(false));
      const WaveIntegrator fixed = fixed_integrator(kj.scene, 16);
      for (const Vec3& x : {targets[0], targets[2]}) {
        const Probed a = probe(kj.integrator, ray_towards(eye, x), 16, 16);
        const Probed b = probe(fixed, ray_towards(eye, x), 16, 16);
        CAPTURE(named.name);
        CAPTURE(named.material.roughness.value);
        CAPTURE(lights[light].name);
        CAPTURE(x.x);
        CAPTURE(a.total.mean());
        CAPTURE(b.total.mean());
        // 1 % for the bias of trees.
        CHECK(p_of_difference(a.total, b.total, 0.01 * b.total.mean() + 1e-5) > significance);
        CHECK(a.indirect.mean() == 0);
      }
    }
}

TEST_CASE("white objects amid equally bright black walls are invisible") {
  struct Named {
    std::string name;
    MaterialKind kind;
    float roughness;
  };
  for (const Named& m :
       {Named{"matte", MaterialKind::diffuse, 0}, Named{"mirror", MaterialKind::conductor, 0},
        Named{"rough metal", MaterialKind::conductor, 0.3f},
        Named{"smooth coat", MaterialKind::coated_diffuse, 0},
        Named{"rough coat", MaterialKind::coated_diffuse, 0.2f},
        Named{"glTF", MaterialKind::metallic_roughness, 0.3f},
        Named{"clear glass", MaterialKind::dielectric, 0},
        Named{"rough glass", MaterialKind::dielectric, 0.3f}}) {
    Scene s;
    const auto quads = add_box_inside(s, add_diffuse(s, Rgb{0}), {-1, -1, 0}, {1, 1, 2});
    for (const uint32_t q : quads) make_light(s, q, Rgb{1});
    Material white;
    white.kind = m.kind;
    white.is_reflectance = true;
    white.base_color.value = Rgb{1};
    white.roughness.value = m.roughness;
    const uint32_t material = add_material(s, white);
    s.spheres.push_back({{0, 0, 0.8f}, 0.5f, false, material, no_light});
    {
      Setting setting;
      const Kj92 kj(s, setting);
      for (const Vec3& x : {Vec3{0, 0, 0.8f}, {0.1f, -0.2f, 1.2f}, {0.5f, 0.3f, 0.9f}}) {
        const Probed p = probe(kj.integrator, ray_towards({0.7f, -0.9f, 1.6f}, x), 32, 8);
        CAPTURE(m.name);
        CAPTURE(x.x);
        CAPTURE(p.total.mean());
        CAPTURE(p.total.standard_error());
        CHECK(std::abs(p.total.mean() - 1) < 0.015 + 4 * p.total.standard_error());
      }
    }
  }
}

TEST_CASE("a furnace: every surface emits what it absorbs, and the picture is 1 everywhere") {
  Scene s;
  for (const uint32_t q : add_box_inside(s, add_diffuse(s, Rgb{0.5f}), {-1, -1, 0}, {1, 1, 2}))
    make_light(s, q, Rgb{0.5f});
  for (const uint32_t q :
       add_box_inside(s, add_diffuse(s, Rgb{0.7f}), {-0.4f, -0.4f, 0.4f}, {0.4f, 0.4f, 1.2f})) {
    std::swap(s.meshes[q].positions[1], s.meshes[q].positions[3]);  // faces outwards
    make_light(s, q, Rgb{0.3f});
  }
  Setting setting;
  setting.radiosity.unshot_fraction = 0.002f;
  setting.radiosity.meshing.element_size = 0.25f;
  setting.radiosity.meshing.patch_size = 1;
  const Kj92 kj(s, setting);
  for (const Vec3& x :
       {Vec3{0, -0.4f, 0.8f}, {0.1f, -0.2f, 1.2f}, {0.9f, 0.8f, 0}, {-0.3f, 1, 1.7f}}) {
    const Probed p = probe(kj.integrator, ray_towards({0.7f, -0.9f, 1.6f}, x), 16, 8);
    CAPTURE(x.x);
    CAPTURE(p.total.mean());
    CHECK(std::abs(p.total.mean() - 1) < 0.02 + 4 * p.total.standard_error());
  }
}

namespace {

// A floor lit only by a bright patch of wall, on which a hidden spot shines, and a post that casts
// a shadow in that light.
Scene bright_wall(int columns) {
  Scene s;
  const uint32_t white = add_diffuse(s, Rgb{0.8f}), grey = add_diffuse(s, Rgb{0.4f});
  const uint32_t black = add_diffuse(s, Rgb{0});
  // The wall x = 0, facing +x. Several columns bend it into an arc.
  Mesh wall;
  for (int i = 0; i <= columns; ++i) {
    const float t = float(i) / float(columns) - 0.5f;
    const float bend = columns == 1 ? 0 : 0.35f * (0.25f - t * t);
    wall.positions.push_back({-bend, 1.2f * t, 0.8f});
    wall.positions.push_back({-bend, 1.2f * t, 2});
  }
  for (uint32_t i = 0; i < uint32_t(columns); ++i) {
    wall.triangles.push_back({2 * i, 2 * i + 2, 2 * i + 3});
    wall.triangles.push_back({2 * i, 2 * i + 3, 2 * i + 1});
  }
  wall.material = white;
  s.meshes.push_back(wall);
  // The lamp shines at the wall from close by and is dark at its back.
  const uint32_t lamp = add_quad(
      s, black,
      {Vec3{0.5f, -0.3f, 1.2f}, {0.5f, -0.3f, 1.6f}, {0.5f, 0.3f, 1.6f}, {0.5f, 0.3f, 1.2f}});
  make_light(s, lamp, Rgb{50});
  add_quad(s, grey, {Vec3{-0.5f, -3, 0}, {5, -3, 0}, {5, 3, 0}, {-0.5f, 3, 0}});
  // A screen between the wall and the floor.
  add_quad(s, black,
           {Vec3{1.2f, -0.5f, 0}, {1.2f, 0.5f, 0}, {1.2f, 0.5f, 0.6f}, {1.2f, -0.5f, 0.6f}});
  return s;
}

}  // namespace

TEST_CASE("a bright patch casts a shadow, and its light counts once") {
  for (const int columns : {1, 16}) {
    Setting setting;
    setting.radiosity.meshing.element_size = 0.2f;
    setting.radiosity.meshing.patch_size = 0.8f;
    setting.radiosity.unshot_fraction = 0.005f;
    const Kj92 kj(bright_wall(columns), setting);
    Setting without = setting;
    without.selection.uses_patches = false;
    const Kj92 plain(bright_wall(columns), without);
    const PathIntegrator path(kj.scene, PathOptions{});
    double all = 0, reference = 0, squares = 0, plain_squares = 0;
    float sampled = 0;
    std::string table;
    for (float x = 0.9f; x < 3.2f; x += 0.2f)  // the screen stands between two of these
      for (const float y : {-0.8f, 0.05f, 0.4f}) {
        const Ray ray = ray_towards({x, y + 0.1f, 0.9f}, {x, y, 0});
        const double a = probe(kj.integrator, ray, 16, 8).total.mean();
        const double b = probe(path, ray, 512, 8).total.mean();
        const double c = probe(plain.integrator, ray, 16, 4).total.mean();
        all += a;
        reference += b;
        squares += (a - b) * (a - b);
        plain_squares += (c - b) * (c - b);
        RadianceBatch out;
        Counters counters;
        const ViewingRays rays = repeated(ray, 1, 4);
        out.reset(4);
        kj.integrator.radiance(rays, *kj.integrator.make_scratch(), out, counters);
        sampled = std::max(sampled, out.sources[0].r);
        char line[120];
        std::snprintf(line, sizeof line,
                      "x %.1f y %+.2f: kj92 %.4f path %.4f without patches %.4f sources %.0f\n",
                      double(x), double(y), a, b, c, double(out.sources[0].r));
        table += line;
      }
    MESSAGE("columns " << columns << "\n" << table << "mean " << all / reference << " of path's");
    CHECK(sampled >= 1);
    CHECK(all == doctest::Approx(reference).epsilon(0.04));
    CHECK(squares < plain_squares);
  }
}

TEST_CASE("mirrors and gloss agree with path in a room with indirect light") {
  struct Named {
    std::string name;
    MaterialKind kind;
    float roughness, rho;
  };
  for (const Named& m : {Named{"mirror", MaterialKind::conductor, 0, 0.9f},
                         {"rough metal", MaterialKind::conductor, 0.3f, 0.9f},
                         {"coated", MaterialKind::coated_diffuse, 0, 0.5f},
                         {"rough coated", MaterialKind::coated_diffuse, 0.3f, 0.5f},
                         {"glTF", MaterialKind::metallic_roughness, 0.2f, 0.7f}}) {
    Scene s;
    add_box_inside(s, add_diffuse(s, Rgb{0.5f}), {-2, -2, 0}, {2, 2, 2.5f});
    Material panel;
    panel.kind = m.kind;
    panel.is_reflectance = true;
    panel.base_color.value = Rgb{m.rho};
    panel.roughness.value = m.roughness;
    add_quad(s, add_material(s, panel),
             {Vec3{-0.2f, 1.9f, 1}, {0.2f, 1.9f, 1}, {0.2f, 1.9f, 1.9f}, {-0.2f, 1.9f, 1.9f}});
    add_ceiling_light(s, 1, 2.4f, Rgb{8});
    Setting setting;
    const Kj92 kj(std::move(s), setting);
    const PathIntegrator path(kj.scene, PathOptions{});
    // Rays towards the panel; at x = 0 the lamp shows in it.
    for (const Vec3& x : {Vec3{0, 1.9f, 1.75f}, {0.15f, 1.9f, 1.1f}, {-0.1f, 1.9f, 1.4f}}) {
      const Ray ray = ray_towards({0.1f, -1, 1.3f}, x);
      const Probed a = probe(kj.integrator, ray, 32, 12), b = probe(path, ray, 256, 12);
      CAPTURE(m.name);
      CAPTURE(x.x);
      CAPTURE(a.total.mean());
      CAPTURE(b.total.mean());
      const double error = std::hypot(a.total.standard_error(), b.total.standard_error());
      CHECK(std::abs(a.total.mean() - b.total.mean()) < 0.04 * b.total.mean() + 4 * error);
    }
  }
}

TEST_CASE("irradiance at a sensor: direct light is exact, total light is close to path") {
  Scene s;
  add_box_inside(s, add_diffuse(s, Rgb{0.5f}), {-2, -2, 0}, {2, 2, 2.5f});
  add_ceiling_light(s, 1, 2.4f, Rgb{8});
  Setting setting;
  setting.radiosity.meshing.element_size = 0.3f;
  setting.radiosity.meshing.patch_size = 1;
  setting.radiosity.unshot_fraction = 0.005f;
  const Kj92 kj(std::move(s), setting);
  const PathIntegrator path(kj.scene, PathOptions{});
  const auto at = [](const Integrator& i, uint32_t samples) {
    SensorBatch sensors;
    sensors.offset = 1e-5f;
    sensors.positions.assign(samples, {0.7f, -0.4f, 0.8f});
    sensors.normals.assign(samples, {0, 0, 1});
    sensors.streams.assign(samples, 5);
    for (uint32_t k = 0; k < samples; ++k) sensors.samples.push_back(k);
    RadianceBatch out;
    out.reset(samples);
    Counters counters;
    i.irradiance(sensors, *i.make_scratch(), out, counters);
    double direct = 0, all = 0;
    for (uint32_t k = 0; k < samples; ++k) {
      direct += double(out.direct[k].g) / samples;
      all += double(out.direct[k].g + out.indirect[k].g) / samples;
    }
    return std::pair{direct, all};
  };
  const auto [direct, all] = at(kj.integrator, 512);
  const double exact = 8 * irradiance(kj.scene.primitives, 0, {0.7, -0.4, 0.8}, {0, 0, 1});
  CHECK(direct == doctest::Approx(exact).epsilon(0.002));
  CHECK(all == doctest::Approx(at(path, 1u << 14).second).epsilon(0.015));
}

TEST_CASE("the result of a batch does not depend on earlier use of its scratch") {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  sources().back().add(s);
  add_floor(s, grey);
  add_quad(s, grey, {Vec3{0.2f, -3, 1}, {1.4f, -3, 1}, {1.4f, 3, 1}, {0.2f, 3, 1}});
  const Kj92 kj(std::move(s), Setting::direct(false));
  const auto run = [&](IntegratorScratch& scratch) {
    RadianceBatch out;
    Counters counters;
    ViewingRays rays;
    for (uint32_t i = 0; i < 64; ++i) {
      rays.rays.push_back(ray_towards(eye, {0.05f * float(i) - 1, -0.5f, 0}));
      rays.streams.push_back(i);
      rays.samples.push_back(0);
    }
    out.reset(rays.size());
    kj.integrator.radiance(rays, scratch, out, counters);
    return out.direct;
  };
  const auto fresh = kj.integrator.make_scratch(), used = kj.integrator.make_scratch();
  const std::vector<Rgb> first = run(*fresh);
  for (int i = 0; i < 3; ++i) {
    probe(kj.integrator, ray_towards(eye, {float(i), 0, 0}), 8, 1);
    run(*used);
  }
  const std::vector<Rgb> again = run(*used);
  for (size_t i = 0; i < first.size(); ++i) CHECK(first[i] == again[i]);
}

}  // namespace test_kj92
