// Sample points on lights. Samples follow pdf_solid_angle() (χ² test), the density integrates to
// one, the inverse inverts, and estimated irradiance agrees with the closed form.
#include <doctest/doctest.h>

#include <cmath>

#include "light/irradiance.h"
#include "light/light_sample.h"
#include "light/light_scene_set.h"
#include "support/chi_square.h"
#include "support/quadrature.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// Receivers in the flat lights' coordinates: over the middle at all distances, over a corner,
// beside the light near its plane, edge-on far away, and beyond the change to sampling by area.
const std::vector<Vec3d> flat_receivers{{0.45, 0.4, 0.5},   {0.45, 0.4, 0.05}, {0.3, 0.08, 0.002},
                                        {0.02, 0.03, 0.01}, {1.6, 0.3, 0.02},  {1.6, -0.3, 1e-4},
                                        {-0.4, 0.5, 0.3},   {3, 2, 1.5},       {8, 1, 0.05},
                                        {0.5, -11, 9},      {0.2, 0.1, 15},    {25, 5, 12},
                                        {40, -60, 0.8},     {100, 300, 700},   {0.5, 0.05, 2e-4}};

// Grid lines on [0,1], geometrically denser towards `focus`.
std::vector<double> crowded_lines(double focus, double finest) {
  std::vector<double> lines{0, 1};
  for (double step = finest; step < 1; step *= 1.7)
    for (const double line : {focus - step, focus + step})
      if (line > 0 && line < 1) lines.push_back(line);
  for (int i = 1; i < 8; ++i) lines.push_back(i / 8.0);
  std::sort(lines.begin(), lines.end());
  lines.erase(
      std::unique(lines.begin(), lines.end(), [](double a, double b) { return b - a < 1e-4; }),
      lines.end());
  lines.back() = 1;
  return lines;
}

size_t bin_of(const std::vector<double>& lines, double v) {
  const auto it = std::upper_bound(lines.begin(), lines.end(), v);
  const auto i = size_t(std::max<ptrdiff_t>(it - lines.begin() - 1, 0));
  return std::min(i, lines.size() - 2);
}

// Density over the (u,v) of SourceSurface, which preserves area: pdf_solid_angle cos / d² area.
double density_uv(const LightPrimitive& p, const SourceSurface& surface, const Vec3& x,
                  const Vec2d& uv) {
  const Vec3d to_point = Vec3d(surface.point_at(Vec2(uv)).point) - Vec3d(x);
  const double d = length(to_point);
  const double height =
      std::abs(dot(p.normal, Vec3d(x) - Vec3d(surface.point_at({0.5f, 0.5f}).point)));
  const float pdf = pdf_solid_angle(p, x, Vec3(to_point / d), float(d));
  return double(pdf) * height / (d * d * d) * surface.area();
}

constexpr int chi_square_count = 6 * 15 * 2 + 20;  // at least the number of χ² tests in this file

ChiSquareResult flat_chi_square(const Scene& scene, const Vec3& x, uint64_t seed) {
  const LightPrimitives primitives(scene);
  const SourceSurface surface(scene, 0);
  const LightPrimitive& p = primitives[0];
  const double height = std::abs(dot(p.normal, Vec3d(x) - Vec3d(p.centroid)));
  const Vec3 foot(Vec3d(x) - p.normal * dot(p.normal, Vec3d(x) - Vec3d(p.centroid)));
  Vec2 focus = surface.uv_at(foot);
  focus = {std::clamp(focus.x, 0.0f, 1.0f), std::clamp(focus.y, 0.0f, 1.0f)};
  const double finest = std::max(height, 2e-3);
  const auto us = crowded_lines(double(focus.x), finest),
             vs = crowded_lines(double(focus.y), finest);
  const size_t nu = us.size() - 1, nv = vs.size() - 1;

  const int n = 100000;
  std::vector<double> observed(nu * nv), expected(nu * nv);
  Random random(seed);
  for (int i = 0; i < n; ++i) {
    LightSample s;
    if (!sample(p, x, random.next_vec2(), s)) continue;
    const Vec2 uv = surface.uv_at(s.point);
    observed[bin_of(us, double(uv.x)) * nv + bin_of(vs, double(uv.y))] += 1;
  }
  for (size_t i = 0; i < nu; ++i)
    for (size_t j = 0; j < nv; ++j)
      expected[i * nv + j] = n * integrate_adaptive_2d(
                                     [&](double u, double v) {
                                       return density_uv(p, surface, x, {u, v});
                                     },
                                     us[i], us[i + 1], vs[j], vs[j + 1], 1e-6, 4, 5);
  return chi_square_test(observed, expected, 1, sidak(1e-4, chi_square_count));
}

}  // namespace

TEST_CASE("samples on flat sources follow their density, which integrates to one") {
  const Pose pose;
  for (const bool behind : {false, true}) {
    uint64_t seed = behind ? 1000 : 1;
    for (const NamedScene& s : flat_scenes(behind)) {
      for (const Vec3d& r : flat_receivers) {
        if (behind && ++seed % 3 != 0) continue;
        const Vec3 x = pose.world({r.x, r.y, behind ? -r.z : r.z});
        const ChiSquareResult result = flat_chi_square(s.scene, x, ++seed);
        CHECK_MESSAGE(result.is_accepted, s.name << " from (" << r.x << ", " << r.y << ", " << r.z
                                                 << (behind ? ") behind: " : "): ")
                                                 << result.text());
      }
    }
  }
}

TEST_CASE("samples on a sphere follow their density, inside and outside") {
  const Pose pose;
  const int n = 100000;
  constexpr size_t rings = 24, sectors = 12;
  for (const double distance : {1.0001, 1.1, 2.0, 30.0, 1e4, 0.6, 0.999, 0.0}) {
    const bool is_inside = distance < 1;
    const Scene scene = sphere_scene(0.5, is_inside);
    const LightPrimitives primitives(scene);
    const LightPrimitive& p = primitives[0];
    const Vec3d axis = normalize(Vec3d{0.2, 0.9, -0.4});
    const Vec3 x = pose.world(axis * (0.5 * distance));
    const Framed frame(normalize(Vec3d(x) - Vec3d(p.centroid) + axis * 1e-30));
    // The visible part, by the cosine at the centre between point and receiver. For a near sphere
    // most of the density is at cosines near 1, hence the square.
    const double true_distance = length(Vec3d(x) - Vec3d(p.centroid)) / 0.5;
    const double least = is_inside ? -1 : 1 / true_distance;
    const auto cosine_at = [&](double t) { return 1 - (1 - least) * t * t; };
    std::vector<double> observed(rings * sectors), expected(rings * sectors);
    Random random(77);
    for (int i = 0; i < n; ++i) {
      LightSample s;
      REQUIRE(sample(p, x, random.next_vec2(), s));
      CHECK(s.is_front);
      // Computed from the direction, because the point itself is rounded in world space.
      const Vec3d q =
          frame.to_local((Vec3d(x) - Vec3d(p.centroid) + Vec3d(s.wi) * double(s.distance)) / 0.5);
      const double t = std::sqrt(std::clamp((1 - q.z) / (1 - least), 0.0, 1.0));
      const double phi = (std::atan2(q.y, q.x) + pi) / (2 * pi);
      observed[std::min(size_t(t * rings), rings - 1) * sectors +
               std::min(size_t(phi * sectors), sectors - 1)] += 1;
    }
    for (size_t i = 0; i < rings; ++i) {
      const auto density = [&](double t, double phi) {
        const double c = cosine_at(t), sine = std::sqrt(std::max(0.0, 1 - c * c));
        const Vec3d normal = frame.to_world({sine * std::cos(phi), sine * std::sin(phi), c});
        const Vec3d to_point = Vec3d(p.centroid) + normal * 0.5 - Vec3d(x);
        const double d = length(to_point);
        const double cosine = std::abs(dot(normal, to_point)) / d;
        const float pdf = pdf_solid_angle(p, x, Vec3(to_point / d), float(d));
        return double(pdf) * cosine / (d * d) * 0.25 * 2 * (1 - least) * t;
      };
      for (size_t j = 0; j < sectors; ++j)
        expected[i * sectors + j] =
            n * integrate_adaptive_2d(density, double(i) / rings, double(i + 1) / rings,
                                      2 * pi * double(j) / sectors - pi,
                                      2 * pi * double(j + 1) / sectors - pi, 1e-7, 6, 8);
    }
    const auto result = chi_square_test(observed, expected, 1, sidak(1e-4, chi_square_count));
    CHECK_MESSAGE(result.is_accepted, "distance " << distance << ": " << result.text());
  }
}

TEST_CASE("point, direction, distance, density and side of a sample are consistent") {
  const Pose pose;
  Random random(5);
  for (const NamedScene& s : flat_scenes()) {
    const LightPrimitives primitives(s.scene);
    const LightPrimitive& p = primitives[0];
    for (const Vec3d& r : flat_receivers) {
      const Vec3 x = pose.world(r);
      for (int i = 0; i < 300; ++i) {
        LightSample e;
        REQUIRE(sample(p, x, random.next_vec2(), e));
        CHECK(length(e.wi) == doctest::Approx(1).epsilon(1e-6));
        CHECK(length(x + e.wi * e.distance - e.point) <= 2e-6f + 1e-6f * e.distance);
        CHECK(e.is_front);
        CHECK(dot(e.wi, e.normal) < 0);
        const float pdf = pdf_solid_angle(p, x, e.wi, e.distance);
        CHECK_MESSAGE(double(pdf) == doctest::Approx(double(e.pdf_solid_angle)).epsilon(1e-4),
                      s.name << " from " << r.x << " " << r.y << " " << r.z);
      }
      LightSample corner;
      for (const Vec2 u : {Vec2{0, 0}, Vec2{0, one_minus_epsilon}, Vec2{one_minus_epsilon, 0},
                           Vec2{one_minus_epsilon, one_minus_epsilon}, Vec2{0.5f, 0.5f}}) {
        REQUIRE(sample(p, x, u, corner));
        CHECK(is_finite(corner.point));
        CHECK(std::isfinite(corner.pdf_solid_angle));
        for (size_t a = 0; a < 3; ++a) {
          CHECK(corner.point[a] >= p.bounds.lower[a] - 1e-6f);
          CHECK(corner.point[a] <= p.bounds.upper[a] + 1e-6f);
        }
      }
    }
  }
}

TEST_CASE("one-sided sources are not visible from behind or from their own plane") {
  const Pose pose;
  LightSample e;
  for (const NamedScene& s : flat_scenes()) {
    const LightPrimitives primitives(s.scene);
    for (const Vec3d& r : flat_receivers) {
      const Vec3 x = pose.world({r.x, r.y, -r.z});
      CHECK_FALSE(sample(primitives[0], x, {0.3f, 0.6f}, e));
      CHECK(pdf_solid_angle(primitives[0], x, Vec3(pose.frame.normal), 1) == 0);
    }
    const Vec3 in_plane =
        primitives[0].vertex_count > 0 ? primitives[0].vertex(0) : primitives[0].centroid;
    CHECK_FALSE(sample(primitives[0], in_plane, {0.3f, 0.6f}, e));
  }
  for (const bool is_inside_out : {false, true}) {
    const LightPrimitives primitives(sphere_scene(1, is_inside_out));
    CHECK(sample(primitives[0], pose.world({0, 0, 2}), {0.3f, 0.6f}, e) != is_inside_out);
    CHECK(sample(primitives[0], pose.world({0, 0, 0.5}), {0.3f, 0.6f}, e) == is_inside_out);
  }
  for (const NamedScene& s : flat_scenes(true)) {
    const LightPrimitives primitives(s.scene);
    REQUIRE(sample(primitives[0], pose.world({0.1, 0.2, -1}), {0.3f, 0.6f}, e));
    CHECK_FALSE(e.is_front);
    CHECK(dot(e.wi, e.normal) < 0);
  }
}

TEST_CASE("inverse sampling recovers the random numbers") {
  Random random(9);
  std::vector<NamedScene> scenes;
  for (NamedScene& s : flat_scenes()) scenes.push_back(std::move(s));
  scenes.push_back({"sphere", sphere_scene(0.2)});
  scenes.push_back({"hollow sphere", sphere_scene(30, true)});
  const Pose pose;
  for (const NamedScene& s : scenes) {
    const LightPrimitives primitives(s.scene);
    for (const Vec3d& r : flat_receivers) {
      // Rounding of the point in world space changes u by the rounding error times the density per
      // area.
      const Vec3 x = pose.world(r);
      if (s.name == "hollow sphere" && length(r) > 29) continue;
      if (s.name == "sphere" && length(r) < 0.21) continue;
      double sum = 0;
      const int n = 200;
      for (int i = 0; i < n; ++i) {
        const Vec2 u = random.next_vec2();
        LightSample e;
        REQUIRE(sample(primitives[0], x, u, e));
        const Vec2 back = square_from_point(primitives[0], x, e.point);
        double du = double(std::abs(back.x - u.x));
        double dv = double(std::abs(back.y - u.y));
        if (s.name != "square") {  // azimuths wrap around
          du = std::min(du, 1 - du);
          dv = std::min(dv, 1 - dv);
        }
        sum += std::max(du, dv);
      }
      CHECK_MESSAGE(sum / n < 1e-4 + 1e-6 / std::abs(r.z), s.name << " from (" << r.x << ", " << r.y
                                                                  << ", " << r.z << "): mean error "
                                                                  << sum / n);
    }
  }
}

TEST_CASE("the mean of cos / pdf is the closed-form irradiance") {
  const Pose pose;
  Random random(11);
  std::vector<NamedScene> scenes;
  for (NamedScene& s : flat_scenes()) scenes.push_back(std::move(s));
  scenes.push_back({"sphere", sphere_scene(0.2)});
  for (const NamedScene& s : scenes) {
    const LightPrimitives primitives(s.scene);
    for (const Vec3d& r : flat_receivers) {
      const Vec3 x = pose.world(r);
      if (s.name == "sphere" && length(r) < 0.21) continue;
      const Vec3d towards = normalize(Vec3d(primitives[0].centroid) - Vec3d(x));
      for (const double tilt : {0.0, 0.7, 1.5}) {
        const Framed frame(towards);
        const Vec3d n = frame.to_world({std::sin(tilt), 0, std::cos(tilt)});
        double sum = 0, squares = 0;
        const int side = 64;
        for (int i = 0; i < side * side; ++i) {
          const Vec2 u{(float(i % side) + random.next_float()) / side,
                       (float(i / side) + random.next_float()) / side};
          LightSample e;
          REQUIRE(sample(primitives[0], x, u, e));
          const double f = std::max(0.0, dot(n, Vec3d(e.wi))) / double(e.pdf_solid_angle);
          sum += f;
          squares += f * f;
        }
        const double count = side * side, mean = sum / count;
        const double deviation = std::sqrt(std::max(0.0, squares / count - mean * mean) / count);
        const double exact = irradiance(primitives[0], Vec3d(x), n);
        // Samples are stratified, so the error is far below this deviation of independent samples.
        CHECK_MESSAGE(std::abs(mean - exact) <= 3 * deviation + 2e-5 * exact,
                      s.name << " from (" << r.x << ", " << r.y << ", " << r.z << ") tilt " << tilt
                             << ": " << mean << " not " << exact << " ± " << deviation);
      }
    }
  }
}

TEST_CASE("random receivers, also on edges and vertices, get finite samples or none") {
  const Pose pose;
  Random random(21);
  std::vector<NamedScene> scenes;
  for (NamedScene& s : flat_scenes(true)) scenes.push_back(std::move(s));
  scenes.push_back({"sphere", sphere_scene(0.2, false, true)});
  scenes.push_back({"needle", mesh_scene({{0, 0, 0}, {1, 0, 0}, {0.5, 1e-5, 0}}, {{0, 1, 2}})});
  for (const NamedScene& s : scenes) {
    const LightPrimitives primitives(s.scene);
    REQUIRE(primitives.size() == 1);
    const LightPrimitive& p = primitives[0];
    const auto number = [&] { return 2 * random.next_double() - 1; };
    for (int i = 0; i < 20000; ++i) {
      const double scale = std::pow(10.0, 4 * number());
      Vec3d local = Vec3d{number(), number(), number()} * scale;
      if (i % 3 == 0) local.z *= 1e-6;
      Vec3 x = pose.world(local);
      if (i % 5 == 0 && p.vertex_count > 0)  // on an edge or its continuation, up to rounding
        x = p.vertex(0) + (p.vertex(1) - p.vertex(0)) * float(2 * number());
      LightSample e;
      if (!sample(p, x, random.next_vec2(), e)) continue;
      const bool is_fine = is_finite(e.point) && is_finite(e.wi) && is_finite(e.normal) &&
                           std::isfinite(e.distance) && std::isfinite(e.pdf_solid_angle) &&
                           e.pdf_solid_angle > 0 && std::abs(length(e.wi) - 1) < 1e-5f;
      CHECK_MESSAGE(is_fine, s.name << " from " << local.x << " " << local.y << " " << local.z);
      const float pdf = pdf_solid_angle(p, x, e.wi, e.distance);
      CHECK(std::isfinite(pdf));
      const double received = irradiance(p, Vec3d(x), Vec3d(e.wi));
      CHECK((received >= 0 && received <= pi));
    }
  }
}
