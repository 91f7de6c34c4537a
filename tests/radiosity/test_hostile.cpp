// Scenes whose mesh would be unbounded without limits: absurd sizes, hair.
#include <doctest/doctest.h>

#include <cmath>

#include "radiosity/rooms.h"

using namespace troffer;
using namespace troffer::test;

namespace {

RadiosityOptions quick() {
  RadiosityOptions o;
  o.meshing = sizes(0.25f, 1);
  o.max_rays = 16;
  o.light_rays = 16;
  o.tolerance = 0.01f;
  return o;
}

double mean_irradiance_in_room(const RadiositySolution& s) {
  double sum = 0, area = 0;
  for (uint32_t i = 0; i < s.mesh.points.size(); ++i) {
    const ElementPoint& p = s.mesh.points[i];
    if (!(length(p.position) < 10)) continue;
    sum += double(luminance(s.irradiance(i)) * p.area);
    area += double(p.area);
  }
  return sum / area;
}

// Returns long thin strips in a lit room, each made of several triangles.
Scene hair(int count, int segments) {
  Scene s = lit_room(0.5f);
  Mesh m;
  m.material = add_diffuse(s, Rgb{0.4f});
  uint32_t state = 1;
  const auto random = [&] {
    state = state * 1664525u + 1013904223u;
    return float(state >> 8) * 0x1p-24f;
  };
  for (int i = 0; i < count; ++i) {
    Vec3 p{1 + 2 * random(), 0.6f + 1.8f * random(), 0.3f};
    const float turn = 6.2831853f * random();
    const Vec3 across{0.0005f * std::cos(turn), 0.0005f * std::sin(turn), 0};
    auto last = uint32_t(m.positions.size());
    m.positions.insert(m.positions.end(), {p - across, p + across});
    for (int k = 0; k < segments; ++k) {
      p += Vec3{0.04f * (random() - 0.5f), 0.04f * (random() - 0.5f), 0.06f};
      const auto next = uint32_t(m.positions.size());
      m.positions.insert(m.positions.end(), {p - across, p + across});
      m.triangles.push_back({last, last + 1, next});
      m.triangles.push_back({next, last + 1, next + 1});
      last = next;
    }
  }
  s.meshes.push_back(std::move(m));
  return s;
}

}  // namespace

TEST_CASE("surfaces too far away to represent are left out with a warning") {
  const double wanted = mean_irradiance_in_room(Ready(lit_room(0.5f)).solve(quick()));
  Scene s = lit_room(0.5f);
  SUBCASE("a sphere of 1e30 m") {
    s.spheres.push_back({{0, 0, 0}, 1e30f, true, 0, no_light});
  }
  SUBCASE("a disk of 1e30 m") {
    s.disks.push_back({{0, 0, -1}, {0, 0, 1}, 1e30f, 0, no_light});
  }
  SUBCASE("a triangle of 1e20 m") {
    add_quad(s, 0, {Vec3{-1e20f, -1e20f, -1}, {1e20f, -1e20f, -1}, {1e20f, 1e20f, -1}, {0, 0, -1}});
  }
  const Ready ready(std::move(s));
  const RadiositySolution solution = ready.solve(quick());
  CHECK(solution.mesh.left_out > 0);
  CHECK(solution.mesh.memory_bytes() < size_t(40) << 20);
  CHECK(mean_irradiance_in_room(solution) == doctest::Approx(wanted).epsilon(1e-3));
  const std::vector<std::string> warnings = radiosity_warnings(solution);
  REQUIRE(!warnings.empty());
  CHECK(warnings[0].find("left out") != std::string::npos);
}

TEST_CASE("very large surfaces stay within the bounds") {
  Scene s = lit_room(0.5f);
  s.spheres.push_back({{0, 0, 0}, 1e8f, true, 0, no_light});
  const Ready ready(std::move(s));
  RadiosityOptions o = quick();
  o.meshing = {};
  const RadiositySolution solution = ready.solve(o);
  CHECK(solution.mesh.element_count <= 24000);
  CHECK(solution.mesh.memory_bytes() < size_t(40) << 20);
}

TEST_CASE("hair: many long thin triangles stay within the bounds, with a warning about accuracy") {
  const Ready ready(hair(4000, 14));
  RadiosityOptions o = quick();
  o.meshing.max_elements = 3000;
  o.meshing.max_sheets = 500;
  const RadiositySolution solution = ready.solve(o);
  CHECK(solution.mesh.element_count <= 3000);
  CHECK(solution.mesh.sheets.size() <= 500);
  CHECK(solution.mesh.memory_bytes() < size_t(60) << 20);
  bool is_told = false;
  for (const std::string& w : radiosity_warnings(solution))
    is_told = is_told || w.find("times as long as requested") != std::string::npos;
  CHECK(is_told);
}
