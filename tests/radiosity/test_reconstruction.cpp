// Interpolated light between sample points, compared with a gather at the same place in the same
// solution.
#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "base/frame.h"
#include "base/random.h"
#include "base/units.h"
#include "base/warp.h"
#include "radiosity/form_factors.h"
#include "radiosity/rooms.h"
#include "trace/surface.h"

using namespace troffer;
using namespace troffer::test;

namespace {

struct Place {
  Hit hit;
  Surface surface;
  Vec3 normal;  // of the viewed side
  bool is_back = false;
};

// Finds the surface that a ray from `eye` hits.
bool look(const Ready& ready, const Vec3& eye, const Vec3& direction, Place& out) {
  const Ray ray{eye, 0, direction};
  ready.tracer.closest({&ray, 1}, {&out.hit, 1});
  if (!out.hit.is_valid()) return false;
  out.surface = surface_at(ready.scene, ray, out.hit);
  out.is_back = dot(out.surface.geometric_normal, direction) > 0;
  out.normal = out.surface.geometric_normal * (out.is_back ? -1.0f : 1.0f);
  return true;
}

// Light directly from lights, and all other light.
struct Parts {
  double direct = 0, reflected = 0;
};

Parts interpolated(const Ready& ready, const RadiositySolution& s, const Place& p) {
  Interpolation at;
  interpolate(ready.scene, s.mesh, p.hit.geometry, p.hit.primitive, p.hit.u, p.hit.v,
              p.surface.position, p.is_back, at);
  Parts sum;
  for (const PointWeight& w : at.weights()) {
    Rgb direct = s.general_direct[w.point];
    for (const StoredContribution& c : s.contributions(w.point))
      if (c.source != no_source && s.is_light(c.source)) direct += c.received;
    sum.direct += double(luminance(direct) * w.weight);
    sum.reflected += double(luminance(s.irradiance(w.point) - direct) * w.weight);
  }
  return sum;
}

// Exact light from lights; light from surfaces by rays that read the solution where they end.
Parts gathered(const Ready& ready, const RadiositySolution& s, const Place& p) {
  constexpr uint32_t rays = 2048;
  ElementPoint receiver;
  receiver.position = p.surface.position;
  receiver.normal = p.normal;
  receiver.offset = 4 * p.surface.offset;
  RayBudget budget;
  budget.max_rays = budget.whole_rays = 1024;
  TransferScratch scratch;
  Parts sum;
  for (uint32_t light = 0; light < s.light_count; ++light) {
    Transfer t;
    transfer(light_shooter(ready.lights, light), {&receiver, 1}, ready.tracer, budget, 1, 0,
             {&t, 1}, scratch);
    sum.direct += double(luminance(t.unoccluded) * t.visibility);
  }
  const Frame frame(p.normal);
  for (uint32_t k = 0; k < rays; ++k) {
    Place at;
    const Vec2 u = SobolGroup(7, 0, k).get2();
    if (!look(ready, p.surface.position + p.normal * receiver.offset,
              frame.to_world(cosine_hemisphere_from_square(u)), at))
      continue;
    const uint32_t material = ready.scene.meshes[at.hit.geometry].material;
    const Rgb rho = evaluate(ready.scene.textures, ready.scene.materials[material].base_color, {});
    const Parts there = interpolated(ready, s, at);
    sum.reflected += double(luminance(rho)) * (there.direct + there.reflected) / rays;
  }
  return sum;
}

// Relative errors at several places.
struct Errors {
  std::vector<double> at;
  double mean() const {
    double sum = 0;
    for (const double e : at) sum += e / double(at.size());
    return sum;
  }
  double rms() const {
    double sum = 0;
    for (const double e : at) sum += e * e / double(at.size());
    return std::sqrt(sum);
  }
  double largest() const {
    double most = 0;
    for (const double e : at) most = std::abs(e) > std::abs(most) ? e : most;
    return most;
  }
};

struct BothErrors {
  Errors all, reflected;
};

void note(const Ready& ready, const RadiositySolution& s, const Place& p, BothErrors& errors) {
  const Parts wanted = gathered(ready, s, p), got = interpolated(ready, s, p);
  errors.all.at.push_back((got.direct + got.reflected) / (wanted.direct + wanted.reflected) - 1);
  errors.reflected.at.push_back(got.reflected / wanted.reflected - 1);
}

std::string told(const Errors& e) {
  return "mean " + std::to_string(e.mean()) + ", rms " + std::to_string(e.rms()) + ", largest " +
         std::to_string(e.largest());
}
std::string told(const BothErrors& e) {
  return "all: " + told(e.all) + "; reflected: " + told(e.reflected);
}

}  // namespace

// A light close below the ceiling shines up. Only the ceiling reflects, so the light on the wall is
// known: many rays with the exact light at their ends.
TEST_CASE("a light close below the ceiling causes no bright ring on the wall") {
  Scene s;
  const auto walls = add_box_inside(s, add_diffuse(s, Rgb{0}), {0, 0, 0}, {4, 5, 3});
  uint32_t ceiling = 0;
  for (const uint32_t w : walls) {
    bool is_high = true;
    for (const Vec3& p : s.meshes[w].positions) is_high = is_high && p.z > 2.9f;
    if (is_high) ceiling = w;
  }
  s.meshes[ceiling].material = add_diffuse(s, Rgb{0.6f});
  const uint32_t q = add_quad(
      s, add_diffuse(s, Rgb{0}),
      {Vec3{0.2f, 2.2f, 2.8f}, {0.8f, 2.2f, 2.8f}, {0.8f, 2.8f, 2.8f}, {0.2f, 2.8f, 2.8f}});
  make_light(s, q, Rgb{10});
  const Ready ready(std::move(s));
  const Shooter light = light_shooter(ready.lights, 0);
  const auto from_light = [&](const Place& p) {
    ElementPoint receiver;
    receiver.position = p.surface.position;
    receiver.normal = p.normal;
    receiver.offset = 4 * p.surface.offset;
    TransferScratch scratch;
    Transfer t;
    transfer(light, {&receiver, 1}, ready.tracer, RayBudget{}, 1, 0, {&t, 1}, scratch);
    return double(luminance(t.unoccluded) * t.visibility);
  };
  RadiosityOptions o;
  o.unshot_fraction = 0.001f;
  const RadiositySolution solution = ready.solve(o);
  Errors errors;
  double sum = 0, wanted_sum = 0;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 14; ++j) {
      Place p;
      REQUIRE(look(ready, {0.1f, 1.5f + 0.1f * (float(i) + 0.5f), 1.4f + 0.1f * float(j)},
                   {-1, 0, 0}, p));
      const Frame frame(p.normal);
      double wanted = from_light(p);
      constexpr uint32_t rays = 2048;
      for (uint32_t k = 0; k < rays; ++k) {
        Place at;
        const Vec2 u = SobolGroup(7, 0, k).get2();
        if (look(ready, p.surface.position + p.normal * p.surface.offset,
                 frame.to_world(cosine_hemisphere_from_square(u)), at) &&
            at.hit.geometry == ceiling)
          wanted += 0.6 * from_light(at) / rays;
      }
      const Parts got = interpolated(ready, solution, p);
      errors.at.push_back((got.direct + got.reflected) / wanted - 1);
      if (i == 9)
        MESSAGE("z " << p.surface.position.z << " wanted " << wanted << " got " << got.reflected);
      sum += got.direct + got.reflected;
      wanted_sum += wanted;
    }
  MESSAGE("wall: " << told(errors) << ", of the sum " << sum / wanted_sum - 1);
  CHECK(errors.rms() < 0.078);
  CHECK(std::abs(errors.largest()) < 0.27);
  CHECK(std::abs(sum / wanted_sum - 1) < 0.045);
}

TEST_CASE("risers of stairs") {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  add_box_inside(s, grey, {0, 0, 0}, {6, 4, 3});
  const uint32_t q = add_quad(
      s, add_diffuse(s, Rgb{0}),
      {Vec3{4.5f, 1.5f, 2.98f}, {4.5f, 2.5f, 2.98f}, {5.5f, 2.5f, 2.98f}, {5.5f, 1.5f, 2.98f}});
  make_light(s, q, Rgb{10});
  for (int i = 0; i < 10; ++i) {
    const float x = 1.5f + 0.28f * float(i), z = 0.17f * float(i);
    add_quad(s, grey, {Vec3{x, 1.4f, z}, {x, 1.4f, z + 0.17f}, {x, 2.6f, z + 0.17f}, {x, 2.6f, z}});
    add_quad(s, grey,
             {Vec3{x, 1.4f, z + 0.17f},
              {x + 0.28f, 1.4f, z + 0.17f},
              {x + 0.28f, 2.6f, z + 0.17f},
              {x, 2.6f, z + 0.17f}});
  }
  const Ready ready(std::move(s));
  for (const float size : {0.0f, 0.6f}) {
    RadiosityOptions o;
    o.meshing.element_size = size;
    const RadiositySolution solution = ready.solve(o);
    BothErrors risers, treads;
    for (int i = 1; i < 10; ++i)
      for (int k = 0; k < 40; ++k) {
        Place p;
        const float x = 1.5f + 0.28f * float(i), z = 0.17f * float(i);
        const Vec2 u = SobolGroup(3, uint32_t(i), uint32_t(k)).get2();
        REQUIRE(look(ready, {x - 0.1f, 1.4f + 1.2f * u.x, z + 0.17f * u.y}, {1, 0, 0}, p));
        note(ready, solution, p, risers);
        REQUIRE(look(ready, {x + 0.28f * u.y, 1.4f + 1.2f * u.x, z + 0.3f}, {0, 0, -1}, p));
        note(ready, solution, p, treads);
      }
    MESSAGE("elements of " << solution.mesh.element_size << " m; risers: " << told(risers)
                           << "; treads: " << told(treads));
    CHECK(risers.reflected.rms() < (size > 0 ? 0.083 : 0.064));
    CHECK(treads.reflected.rms() < (size > 0 ? 0.082 : 0.0515));
  }
}

TEST_CASE("smooth shapes show neither facets nor stripes") {
  for (const uint32_t sectors : {24u, 96u}) {
    Scene s;
    const uint32_t grey = add_diffuse(s, Rgb{0.5f});
    add_box_inside(s, grey, {0, 0, 0}, {5, 4, 3});
    const uint32_t q =
        add_quad(s, add_diffuse(s, Rgb{0}),
                 {Vec3{3.5f, 1, 2.98f}, {3.5f, 2, 2.98f}, {4.5f, 2, 2.98f}, {4.5f, 1, 2.98f}});
    make_light(s, q, Rgb{10});
    Mesh m;
    m.material = grey;
    const uint32_t rings = sectors / 2;
    for (uint32_t i = 0; i <= rings; ++i)
      for (uint32_t j = 0; j < sectors; ++j) {
        const float a = pi_f * float(i) / float(rings), b = 2 * pi_f * float(j) / float(sectors);
        const Vec3 n{std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)};
        m.positions.push_back(Vec3{2, 2, 1} + n * 0.6f);
        m.normals.push_back(n);
      }
    for (uint32_t i = 0; i < rings; ++i)
      for (uint32_t j = 0; j < sectors; ++j) {
        const uint32_t a = i * sectors + j, b = i * sectors + (j + 1) % sectors;
        m.triangles.push_back({a, a + sectors, b});
        m.triangles.push_back({b, a + sectors, b + sectors});
      }
    s.meshes.push_back(m);
    const Ready ready(std::move(s));
    const RadiositySolution solution = ready.solve();
    BothErrors errors;
    Random random(5);
    for (int i = 0; i < 400; ++i) {
      const Vec3 n = sphere_from_square(random.next_vec2());
      if (n.z < 0) continue;
      Place p;
      REQUIRE(look(ready, Vec3{2, 2, 1} + n * 0.9f, -n, p));
      p.normal = n;  // normal of the true shape
      note(ready, solution, p, errors);
    }
    MESSAGE(sectors << " sectors, elements of " << solution.mesh.element_size
                    << " m: " << told(errors));
    CHECK(errors.all.rms() < (sectors < 96 ? 0.044 : 0.032));
  }
}
