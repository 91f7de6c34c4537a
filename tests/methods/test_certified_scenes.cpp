// The certified integrator on hostile scenes: sources on, in and behind occluders, surfaces with
// two horizons, sources much nearer than they are large. The reference is fixed sampling with many
// rays from the same places.
#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "probe.h"

using namespace troffer;
using namespace troffer::test;

namespace test_certified_scenes {

namespace {

constexpr float half_pi_f = 1.57079633f;

struct HostileScene {
  std::string name;
  std::function<void(Scene&)> build;
  Vec3 eye;
  std::vector<Vec3> targets;
};

void add_sheet(Scene& s, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  add_quad(s, 0, {a, b, c, d});
}

void add_floor(Scene& s, uint32_t material = 0) {
  add_quad(s, material, {Vec3{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}});
}

// Adds a downward panel [x0,x1] × [y0,y1] at height z.
void add_panel(Scene& s, float x0, float x1, float y0, float y1, float z, float radiance) {
  make_light(s, add_quad(s, 0, {Vec3{x0, y0, z}, {x0, y1, z}, {x1, y1, z}, {x1, y0, z}}),
             Rgb{radiance});
}

// Adds a coarse ball with smooth normals: its own facets hide directions that its normals face.
void add_smooth_ball(Scene& s, uint32_t material, const Vec3& centre, float radius) {
  constexpr uint32_t rows = 8, columns = 14;
  Mesh m;
  m.material = material;
  for (uint32_t i = 0; i <= rows; ++i)
    for (uint32_t j = 0; j < columns; ++j) {
      const float theta = 2 * half_pi_f * float(i) / float(rows);
      const float phi = 4 * half_pi_f * float(j) / float(columns);
      const Vec3 n{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                   std::cos(theta)};
      m.normals.push_back(n);
      m.positions.push_back(centre + n * radius);
    }
  for (uint32_t i = 0; i < rows; ++i)
    for (uint32_t j = 0; j < columns; ++j) {
      const uint32_t a = i * columns + j, b = i * columns + (j + 1) % columns;
      if (i > 0) m.triangles.push_back({a, a + columns, b});
      if (i + 1 < rows) m.triangles.push_back({b, a + columns, b + columns});
    }
  s.meshes.push_back(std::move(m));
}

uint32_t add_coat(Scene& s, float roughness) {
  Material m;
  m.kind = MaterialKind::coated_diffuse;
  m.base_color.value = Rgb{0.5f};
  m.roughness.value = roughness;
  return add_material(s, m);
}

const Vec3 eye{0, -6, 3};
const std::vector<Vec3> floor_points{{0.2f, -0.9f, 0}, {-0.8f, 0.4f, 0}, {1.1f, -0.3f, 0}};

std::vector<HostileScene> hostile_scenes() {
  std::vector<HostileScene> all;
  const auto on_floor = [&](const std::string& name, std::function<void(Scene&)> build) {
    all.push_back({name,
                   [build](Scene& s) {
                     add_floor(s);
                     build(s);
                   },
                   eye, floor_points});
  };
  on_floor("bulb half sunk into the floor behind a step", [](Scene& s) {
    add_sphere_light(s, 0, {0, 0.3f, 0}, 0.5f, Rgb{5});
    add_block(s, 0, {-1, -0.5f, 0}, {0.5f, -0.4f, 0.3f});
  });
  on_floor("bulb with a socket and a wire stuck in", [](Scene& s) {
    add_sphere_light(s, 0, {0, 0, 1.5f}, 0.5f, Rgb{5});
    add_block(s, 0, {-0.2f, -0.2f, 1.7f}, {0.2f, 0.2f, 2.5f});
    add_block(s, 0, {-0.1f, -0.6f, 0.9f}, {0.1f, 0.1f, 1.3f});
  });
  on_floor("bulb behind balls", [](Scene& s) {
    add_sphere_light(s, 0, {0, 0, 2.5f}, 0.3f, Rgb{20});
    s.spheres.push_back({{0.1f, 0, 1.3f}, 0.4f, false, 0, no_light});
  });
  on_floor("bulb in a shade that cuts it, hung from a wire", [](Scene& s) {
    add_sphere_light(s, 0, {0, 0, 2}, 0.2f, Rgb{20});
    for (int i = 0; i < 4; ++i) {
      const float x = i == 0 ? 1 : i == 2 ? -1 : 0, y = i == 1 ? 1 : i == 3 ? -1 : 0;
      const auto at = [&](float r, float side, float z) {
        return Vec3{r * (x - side * y), r * (y + side * x), z};
      };
      add_sheet(s, at(0.3f, -1, 1.85f), at(0.3f, 1, 1.85f), at(0.1f, 1, 2.2f), at(0.1f, -1, 2.2f));
    }
    add_block(s, 0, {-0.01f, -0.01f, 2.15f}, {0.01f, 0.01f, 3});
  });
  on_floor("bulb on a disk, half in a ball", [](Scene& s) {
    add_sphere_light(s, 0, {0, 0, 1.5f}, 0.3f, Rgb{5});
    s.disks.push_back({{0, 0.1f, 1.4f}, {0, 0, 1}, 0.4f, 0, no_light});
    s.spheres.push_back({{0.3f, 0, 1.6f}, 0.25f, false, 0, no_light});
  });
  on_floor("panel through which a ball and a disk stand", [](Scene& s) {
    add_panel(s, -0.5f, 0.5f, -0.5f, 0.5f, 1.5f, 5);
    s.spheres.push_back({{0.2f, 0, 1.45f}, 0.2f, false, 0, no_light});
    s.disks.push_back({{-0.2f, 0, 1.5f}, {0.8f, 0.6f, 0}, 0.3f, 0, no_light});
  });
  on_floor("bulbs that reach into each other", [](Scene& s) {
    add_sphere_light(s, 0, {0, 0, 1.5f}, 0.5f, Rgb{5});
    add_sphere_light(s, 0, {0.3f, -0.1f, 1.4f}, 0.4f, Rgb{3});
  });
  on_floor("bulb that reaches into an inverted box", [](Scene& s) {
    add_sphere_light(s, 0, {0, 0, 1.5f}, 0.4f, Rgb{5});
    add_box_inside(s, 0, {-0.6f, -0.6f, 0.8f}, {0.6f, 0.6f, 1.2f});
  });
  on_floor("panel before which a sheet lies a hair away", [](Scene& s) {
    add_panel(s, -0.5f, 0.5f, -0.5f, 0.5f, 2.5f, 5);
    add_sheet(s, {-0.2f, -0.2f, 2.4999f}, {0.2f, -0.2f, 2.4999f}, {0.2f, 0.2f, 2.4999f},
              {-0.2f, 0.2f, 2.4999f});
  });
  on_floor("comb of blades under a panel", [](Scene& s) {
    add_panel(s, -0.5f, 0.5f, -0.5f, 0.5f, 2.5f, 5);
    for (int i = 0; i < 50; ++i) {
      const float x = -1 + 0.04f * float(i);
      add_sheet(s, {x, -1, 1}, {x + 0.02f, -1, 1}, {x + 0.02f, 1, 1}, {x, 1, 1});
    }
  });
  on_floor("post that stands through floor and panel", [](Scene& s) {
    add_panel(s, -0.5f, 0.5f, -0.5f, 0.5f, 1.5f, 5);
    add_block(s, 0, {-0.2f, -0.1f, -1}, {0.2f, 0.3f, 3});
  });
  on_floor("doubled panel in a doubled ceiling", [](Scene& s) {
    for (int i = 0; i < 2; ++i) {
      add_sheet(s, {-4, -4, 2.5f}, {-4, 4, 2.5f}, {4, 4, 2.5f}, {4, -4, 2.5f});
      add_panel(s, -0.5f, 0.5f, -0.5f, 0.5f, 2.5f, 5);
    }
    add_block(s, 0, {-1, -0.2f, 0.3f}, {0.5f, 0.2f, 0.6f});
  });
  on_floor("disk close to the floor, a ball before it", [](Scene& s) {
    add_disk_light(s, 0, {0, 0, 0.4f}, {0, 0, -1}, 0.8f, Rgb{5});
    s.spheres.push_back({{0.2f, -0.6f, 0.1f}, 0.1f, false, 0, no_light});
  });
  all.push_back({"panel a hundred metres wide over a block",
                 [](Scene& s) {
                   add_floor(s);
                   add_panel(s, -50, 50, -50, 50, 3, 1);
                   add_block(s, 0, {-0.3f, -0.3f, 0}, {0.3f, 0.3f, 0.2f});
                 },
                 {0, -1, 0.5f},
                 {{0, -0.5f, 0}, {0.1f, -0.4f, 0}, {0.5f, 0.1f, 0}}});
  const Vec3 side{0, -3, 1.5f};
  const std::vector<Vec3> edge{{0.02f, -0.5f, 0.5f}, {0.1f, -0.55f, 0.75f}, {-0.1f, -0.4f, 1.1f}};
  for (const bool is_coated : {false, true})
    all.push_back({is_coated ? "disk at the horizon of a coated smooth ball"
                             : "disk at the horizon of a matte smooth ball",
                   [is_coated](Scene& s) {
                     const uint32_t coat = add_coat(s, 0.3f);
                     add_smooth_ball(s, is_coated ? coat : 0, {0, 0, 0.7f}, 0.6f);
                     add_disk_light(s, 0, {2, 0, 2}, {0, 0, -1}, 0.3f, Rgb{5});
                   },
                   side, edge});
  all.push_back({"bulb at the horizon of a smooth ball",
                 [](Scene& s) {
                   add_smooth_ball(s, 0, {0, 0, 0.7f}, 0.6f);
                   add_sphere_light(s, 0, {2, 0, 0.7f}, 0.3f, Rgb{5});
                 },
                 side, edge});
  return all;
}

}  // namespace

TEST_CASE("certified: hostile scenes agree with fixed sampling") {
  const std::vector<HostileScene> scenes = hostile_scenes();
  const double significance = sidak(1e-3, int(3 * scenes.size()));
  for (const HostileScene& h : scenes) {
    Scene s;
    add_diffuse(s, Rgb{0.6f});
    h.build(s);
    const PreparedScene scene(std::move(s));
    const WaveIntegrator mine = certified_integrator(scene);
    const WaveIntegrator fixed = fixed_integrator(scene, 256);
    for (const Vec3& x : h.targets) {
      const Probed a = probe(mine, ray_towards(h.eye, x), 64, 32);
      const Probed b = probe(fixed, ray_towards(h.eye, x), 8, 32, 77);
      CAPTURE(h.name);
      CAPTURE(x.x);
      CAPTURE(a.total.mean());
      CAPTURE(a.total.standard_error());
      CAPTURE(b.total.mean());
      CAPTURE(b.total.standard_error());
      CHECK(p_of_difference(a.total, b.total, 1e-4 * b.total.mean()) > significance);
    }
  }
}

TEST_CASE("flat sources do not light their own backs, on whichever side rounding puts hits") {
  for (const bool is_disk : {false, true}) {
    Scene s;
    add_diffuse(s, Rgb{0.5f});
    const Vec3 normal = normalize(Vec3{0.1f, -0.3f, -1}), centre{0.31f, -0.17f, 0.7f};
    if (is_disk) {
      add_disk_light(s, 0, centre, normal, 0.8f, Rgb{5});
    } else {
      const Vec3 u = normalize(cross(normal, Vec3{0, 1, 0})) * 0.8f, v = cross(normal, u);
      make_light(s,
                 add_quad(s, 0, {centre - u - v, centre + u - v, centre + u + v, centre - u + v}),
                 Rgb{5});
    }
    const PreparedScene scene(std::move(s));
    const WaveIntegrator mine = certified_integrator(scene);
    const WaveIntegrator fixed = fixed_integrator(scene, 64);
    const PathIntegrator path(scene, PathOptions{1});
    const std::vector<const Integrator*> methods{&mine, &fixed, &path};
    Random random(5);
    for (int i = 0; i < 60; ++i) {
      const Vec3 spread{random.next_float() - 0.5f, random.next_float() - 0.5f, 0};
      for (const Integrator* method : methods)
        CHECK(probe(*method, ray_towards({0.3f, 0.6f, 4}, centre + spread), 8, 1, uint64_t(i))
                  .total.mean() == 0);
    }
  }
}

TEST_CASE("a sphere that shines outwards does not light its inside, whatever rounding does") {
  for (const Vec3& centre : {Vec3{0, 0, 0}, Vec3{2, 2, 2}, Vec3{-30, 7, 11}}) {
    Scene s;
    add_diffuse(s, Rgb{0.6f});
    add_sphere_light(s, 0, centre, 0.3f, Rgb{10});
    const PreparedScene scene(std::move(s));
    const WaveIntegrator mine = certified_integrator(scene), fixed = fixed_integrator(scene, 16);
    const PathIntegrator path(scene, PathOptions{1});
    Random random(3);
    for (int i = 0; i < 100; ++i) {
      const Vec3 towards = centre + Vec3{random.next_float() - 0.5f, random.next_float() - 0.5f,
                                         random.next_float() - 0.5f};
      for (const Integrator* method :
           {static_cast<const Integrator*>(&mine), static_cast<const Integrator*>(&fixed),
            static_cast<const Integrator*>(&path)})
        CHECK(probe(*method, ray_towards(centre, towards), 4, 1, uint64_t(i)).total.mean() == 0);
    }
  }
}

// The bulb's fixture enters it, and balls and disks are no facets, but all lists are complete.
TEST_CASE("certified: bulbs in fixtures, balls and disks need no ray") {
  const std::vector<HostileScene> all = hostile_scenes();
  size_t found = 0;
  for (const HostileScene& n : all) {
    const bool is_bulb = n.name.find("bulb") != std::string::npos;
    const bool is_round = n.name.find("ball") != std::string::npos;
    if (!is_bulb && !is_round) continue;
    ++found;
    Scene s;
    add_diffuse(s, Rgb{0.6f});
    n.build(s);
    const PreparedScene scene(std::move(s));
    const WaveIntegrator mine = certified_integrator(scene);
    RadianceBatch out;
    Counters counters;
    const ViewingRays rays = repeated(ray_towards(n.eye, n.targets[0]), 5, 64);
    out.reset(rays.size());
    mine.radiance(rays, *mine.make_scratch(), out, counters);
    CAPTURE(n.name);
    CHECK(counters.shadow_rays == 0);
  }
  CHECK(found >= 8);
}

TEST_CASE(
    "certified: sources without light, and with radiances too large to square in single "
    "precision") {
  for (const float radiance : {0.0f, 1e25f}) {
    Scene s;
    add_diffuse(s, Rgb{0.5f});
    add_floor(s);
    add_panel(s, -0.5f, 0.5f, -0.5f, 0.5f, 2, radiance);
    s.spheres.push_back({{0, -0.4f, 0.8f}, 0.2f, false, 0, no_light});
    add_leaf(
        s,
        {Vec3{-0.3f, -0.7f, 0.8f}, {0.3f, -0.7f, 0.8f}, {0.3f, -0.1f, 0.8f}, {-0.3f, -0.1f, 0.8f}});
    const PreparedScene scene(std::move(s));
    const WaveIntegrator mine = certified_integrator(scene);
    const WaveIntegrator fixed = fixed_integrator(scene, 256);
    const Ray ray = ray_towards(eye, {0.3f, -0.9f, 0});
    const double a = probe(mine, ray, 64, 8).total.mean(),
                 b = probe(fixed, ray, 64, 8).total.mean();
    CAPTURE(radiance);
    CHECK(a == doctest::Approx(b).epsilon(0.02));
    CHECK((b > 0) == (radiance > 0));
  }
}

}  // namespace test_certified_scenes
