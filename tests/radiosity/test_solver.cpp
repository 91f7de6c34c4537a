// Enclosures with known solutions, conservation of energy, independence of threads.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>

#include "radiosity/rooms.h"
#include "support/light_scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace {

double area_of(const RadiosityMesh& mesh) {
  double a = 0;
  for (const ElementPoint& p : mesh.points) a += double(p.area);
  return a;
}

double mean_irradiance(const RadiositySolution& s) {
  double sum = 0;
  for (uint32_t i = 0; i < s.mesh.points.size(); ++i)
    sum += double(luminance(s.irradiance(i)) * s.mesh.points[i].area);
  return sum / area_of(s.mesh);
}

void check_balance(const RadiositySolution& s, double tolerance) {
  const EnergyBalance& b = s.balance;
  CHECK(b.absorbed + b.lost_to_specular + b.unshot + b.escaped + b.unaccounted ==
        doctest::Approx(b.emitted).epsilon(1e-5));
  CHECK(std::abs(b.escaped) < tolerance * b.emitted);
  CHECK(std::abs(b.unaccounted) < tolerance * b.emitted);
}

}  // namespace

TEST_CASE("heterogeneous furnace: the same radiance everywhere") {
  constexpr float radiance = 2;
  Scene s;
  const float rho[6] = {0.2f, 0.8f, 0.5f, 0.3f, 0.7f, 0.6f};
  add_furnace_box(s, {0, 0, 0}, {3, 2, 2.5f}, rho, radiance);
  add_furnace_block(s, {1, 0.7f, 0.4f}, {1.8f, 1.2f, 1.3f}, 0.4f, radiance);
  add_furnace_block(s, {0.3f, 0.3f, 1.5f}, {0.5f, 1.5f, 1.6f}, 0.75f, radiance);
  const Ready ready(std::move(s));
  RadiosityOptions o;
  o.meshing = sizes(0.45f, 1.2f);
  o.unshot_fraction = 1e-4f;
  o.max_rays = 1024;
  o.tolerance = 2e-4f;
  const RadiositySolution solution = ready.solve(o);
  CHECK(solution.is_complete);
  double worst = 0, squares = 0;
  for (uint32_t i = 0; i < solution.mesh.points.size(); ++i) {
    const double e = double(solution.irradiance(i).g) / (pi * double(radiance)) - 1;
    worst = std::max(worst, std::abs(e));
    squares += e * e;
  }
  MESSAGE("furnace: largest error "
          << worst << ", rms " << std::sqrt(squares / double(solution.mesh.points.size())) << ", "
          << solution.mesh.points.size() << " points, " << solution.shots << " shots, "
          << double(solution.rays) * 1e-6 << " M rays");
  CHECK(worst < 0.01);
  check_balance(solution, 0.005);
}

TEST_CASE("uniform closed room: mean irradiance is Phi / (A (1 - rho))") {
  for (const float rho : {0.3f, 0.8f}) {
    Scene s;  // the walls themselves emit, so that only walls absorb
    const auto quads = add_box_inside(s, add_diffuse(s, Rgb{rho}), {0, 0, 0}, {4, 3, 2.5f});
    make_light(s, quads[1], Rgb{3});
    const Ready ready(std::move(s));
    RadiosityOptions o;
    o.meshing = sizes(0.5f, 1.6f);
    o.unshot_fraction = 0.001f;
    const RadiositySolution solution = ready.solve(o);
    CHECK(solution.is_complete);
    const double area = 2 * (4 * 3 + 4 * 2.5 + 3 * 2.5);
    CHECK(area_of(solution.mesh) == doctest::Approx(area).epsilon(1e-4));
    const double expected = pi * 3 * 12 / (area * (1 - double(rho)));
    CHECK(mean_irradiance(solution) == doctest::Approx(expected).epsilon(0.01));
    check_balance(solution, 0.01);
  }
}

TEST_CASE("integrating sphere") {
  // One triangle of the tessellated sphere emits; after the first bounce E is uniform.
  constexpr float rho = 0.8f;
  Scene s;
  const uint32_t white = add_diffuse(s, Rgb{rho});
  Mesh m;
  m.material = white;
  constexpr uint32_t rings = 16, sectors = 24;
  for (uint32_t i = 0; i <= rings; ++i)
    for (uint32_t j = 0; j < sectors; ++j) {
      const float a = pi_f * float(i) / rings, b = 2 * pi_f * float(j) / sectors;
      m.positions.push_back({std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)});
    }
  for (uint32_t i = 0; i < rings; ++i)
    for (uint32_t j = 0; j < sectors; ++j) {
      const uint32_t a = i * sectors + j, b = i * sectors + (j + 1) % sectors;
      m.triangles.push_back({a, b, a + sectors});
      m.triangles.push_back({b, b + sectors, a + sectors});
    }
  const uint32_t lamp = uint32_t(m.triangles.size()) / 2;
  m.lights.assign(m.triangles.size(), no_light);
  m.lights[lamp] = 0;
  Light e;
  e.kind = LightKind::mesh;
  e.radiance = Rgb{100};
  e.triangles = {lamp};
  s.meshes.push_back(m);
  s.lights.push_back(e);
  const Ready ready(std::move(s));
  RadiosityOptions o;
  o.meshing = sizes(0.3f, 0.9f);
  o.unshot_fraction = 0.003f;
  const RadiositySolution solution = ready.solve(o);
  CHECK(solution.is_complete);
  const double expected = solution.balance.emitted / (area_of(solution.mesh) * (1 - double(rho)));
  // Flat facets near the lamp have another orientation than the sphere.
  const Vec3 lamp_position = m.positions[m.triangles[lamp][0]];
  double worst = 0;
  for (uint32_t i = 0; i < solution.mesh.points.size(); ++i)
    if (length(solution.mesh.points[i].position - lamp_position) > 0.7f)
      worst = std::max(worst, std::abs(double(solution.irradiance(i).g) / expected - 1));
  MESSAGE("integrating sphere: largest deviation " << worst << ", mean "
                                                   << mean_irradiance(solution) / expected);
  CHECK(mean_irradiance(solution) == doctest::Approx(expected).epsilon(0.02));
  CHECK(worst < 0.08);
  check_balance(solution, 0.02);
}

TEST_CASE("stored contributions and the general value add up to the total") {
  const Ready ready(lit_room(0.5f));
  RadiosityOptions o;
  o.meshing = sizes(0.4f, 1.2f);
  o.unshot_fraction = 0.1f;
  const RadiositySolution four = ready.solve(o);
  o.stored_per_point = 0;
  const RadiositySolution none = ready.solve(o);
  o.stored_per_point = 64;
  const RadiositySolution many = ready.solve(o);
  REQUIRE(four.mesh.points.size() == none.mesh.points.size());
  bool has_light = false, has_patch = false;
  for (uint32_t i = 0; i < four.mesh.points.size(); ++i) {
    const Rgb a = four.irradiance(i), b = none.irradiance(i), c = many.irradiance(i);
    CHECK(a.g == doctest::Approx(b.g).epsilon(1e-5));
    CHECK(a.g == doctest::Approx(c.g).epsilon(1e-5));
    CHECK(four.contributions(i).size() == 4);
    Rgb sum = four.general[i];
    for (const StoredContribution& s : four.contributions(i)) {
      sum += s.received;
      if (s.source == no_source) continue;
      CHECK(s.received.g <= s.unoccluded.g * 1.00001f);
      (four.is_light(s.source) ? has_light : has_patch) = true;
      if (!four.is_light(s.source)) CHECK(four.patch_of(s.source) < four.mesh.patches.size());
    }
    CHECK(sum == a);
  }
  CHECK(has_light);
  CHECK(has_patch);
}

TEST_CASE("the result is the same for any number of threads") {
  const Ready ready(lit_room(0.6f));
  RadiosityOptions o;
  o.meshing = sizes(0.4f, 1.2f);
  o.unshot_fraction = 0.1f;
  const RadiositySolution one = ready.solve(o, 1), three = ready.solve(o, 3);
  REQUIRE(one.general.size() == three.general.size());
  CHECK(std::memcmp(one.general.data(), three.general.data(), one.general.size() * sizeof(Rgb)) ==
        0);
  CHECK(std::memcmp(one.stored.data(), three.stored.data(),
                    one.stored.size() * sizeof(StoredContribution)) == 0);
  CHECK(one.shots == three.shots);
  CHECK(one.rays == three.rays);
  CHECK(one.balance.absorbed == three.balance.absorbed);
}

TEST_CASE("a stop ends after the current shot") {
  const Ready ready(lit_room(0.8f));
  StopFlag stop = false;
  RadiosityOptions o;
  o.meshing = sizes(0.4f, 1.2f);
  double last = 2;
  const RadiositySolution s = solve_radiosity(
      ready.scene, ready.tracer, ready.tables, ready.lights, o, 2,
      [&](const RadiosityProgress& p) {
        last = p.unshot;
        if (p.shots == 5) stop = true;
      },
      stop);
  CHECK(s.shots == 5);
  CHECK_FALSE(s.is_complete);
  CHECK(last == doctest::Approx(s.balance.unshot / s.balance.emitted));
  CHECK(s.ambient.g > 0);
}

TEST_CASE("light that is not reflected diffusely is counted") {
  Scene s = lit_room(0.5f);
  Material mirror;
  mirror.kind = MaterialKind::conductor;
  mirror.is_reflectance = true;
  mirror.base_color.value = Rgb{0.9f};
  s.meshes[2].material = add_material(s, mirror);
  const Ready ready(std::move(s));
  RadiosityOptions o;
  o.meshing = sizes(0.4f, 1.2f);
  const RadiositySolution solution = ready.solve(o);
  CHECK(solution.balance.lost_to_specular > 0.05 * solution.balance.emitted);
  check_balance(solution, 0.02);
  for (const ElementPoint& p : solution.mesh.points)
    if (p.position.y == 0) {
      CHECK(p.reflectance.g == 0);
      CHECK(p.specular_albedo.g == doctest::Approx(0.91f).epsilon(0.05));
    }
}

TEST_CASE("every kind of emitter shoots its power") {
  for (int kind = 0; kind < 3; ++kind) {
    Scene s;
    const uint32_t black = add_diffuse(s, Rgb{0});
    add_box_inside(s, black, {-2, -2, -2}, {2, 2, 2});
    if (kind == 0) add_sphere_light(s, black, {0.2f, 0, 0.1f}, 0.4f, Rgb{3});
    if (kind == 1) add_disk_light(s, black, {0.2f, 0, 0.1f}, {0, 0.6f, 0.8f}, 0.4f, Rgb{3}, true);
    if (kind == 2) {
      std::vector<Vec3> p;
      std::vector<Triangle> t;
      for (uint32_t i = 0; i < 40; ++i) {
        const float x = 0.02f * float(i);
        p.insert(p.end(), {{x, 0, 0}, {x + 0.02f, 0, 0}, {x, 0.3f, 0.1f}});
        t.push_back({3 * i, 3 * i + 1, 3 * i + 2});
      }
      add_mesh_light(s, black, p, t, Rgb{3}, true);
    }
    const Ready ready(std::move(s));
    RadiosityOptions o;
    o.meshing = sizes(0.2f, 0.8f);
    const RadiositySolution solution = ready.solve(o);
    CHECK(solution.balance.emitted > 0);
    check_balance(solution, 0.01);
  }
}

TEST_CASE("coincident surfaces of several meshes: copies count once, and solving ends for others") {
  for (const float gap : {0.0f, 1e-6f, 1e-4f}) {
    Scene s = lit_room(0.9f);
    const size_t alone_meshes = s.meshes.size();
    const uint32_t white = add_diffuse(s, Rgb{0.9f});
    for (int copy = 0; copy < 3; ++copy) {  // of the floor and of one wall
      const float d = gap * float(copy + 1);
      add_quad(s, white, {Vec3{0, 0, d}, {4, 0, d}, {4, 3, d}, {0, 3, d}});
      add_quad(s, white, {Vec3{d, 0, 0}, {d, 3, 0}, {d, 3, 2.5f}, {d, 0, 2.5f}});
    }
    for (size_t m = 0; m < s.meshes.size(); m += 2)  // some have the opposite orientation
      if (m >= alone_meshes)
        for (Triangle& t : s.meshes[m].triangles) std::swap(t[1], t[2]);
    const Ready copies(std::move(s)), alone(lit_room(0.9f));
    RadiosityOptions o;
    o.meshing = sizes(1, 2);
    o.unshot_fraction = 0.1f;
    const RadiositySolution a = copies.solve(o), b = alone.solve(o);
    CHECK(a.is_complete);
    CHECK(a.shots < 6 * b.shots);
    float most_a = 0, most_b = 0;
    for (uint32_t i = 0; i < a.mesh.points.size(); ++i)
      most_a = std::max(most_a, a.irradiance(i).g);
    for (uint32_t i = 0; i < b.mesh.points.size(); ++i)
      most_b = std::max(most_b, b.irradiance(i).g);
    MESSAGE("gap " << gap << ": brightest point " << most_a << ", " << most_b << " without copies; "
                   << a.shots << " shots, " << b.shots);
    CHECK(most_a < (gap == 0 ? 1.02f : 1.1f) * most_b);
    CHECK(a.balance.absorbed <= 1.001 * a.balance.emitted);
  }
}
