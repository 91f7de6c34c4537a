// Portals: rectangles through which alone an environment light is seen. Tests what they show and
// how directions through them are sampled.
#include <doctest/doctest.h>

#include <cmath>

#include "base/random.h"
#include "base/units.h"
#include "light/light.h"
#include "light/portal.h"
#include "light/sky_patches.h"
#include "support/chi_square.h"
#include "support/light_scenes.h"
#include "support/surfaceless_lights.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// 2 × 1 m at x = 3, facing receivers at x < 3.
const std::vector<Vec3> window = {{3, -1, 1}, {3, -1, 2}, {3, 1, 2}, {3, 1, 1}};

// A floor and an environment light with a portal. has_image: the light is an image, very bright in
// a few texels and black in others.
Scene with_portal(bool has_image, const std::vector<Vec3>& portal = window) {
  Scene s;
  add_quad(s, add_diffuse(s, Rgb{0.5f}), {Vec3{-3, -4, 0}, {3, -4, 0}, {3, 4, 0}, {-3, 4, 0}});
  Light& e = add_light(s, LightKind::environment, Rgb{2});
  e.portal = portal;
  if (!has_image) return s;
  EnvironmentMap map;
  map.projection = SphereMap::equal_area;
  map.width = map.height = 32;
  Random random(5);
  for (int i = 0; i < 32 * 32; ++i) {
    const float v = random.next_float();
    map.texels.push_back(v < 0.3f ? Rgb{0} : v > 0.99f ? Rgb{300} : Rgb{v, v * v, 1});
  }
  s.environments.push_back(map);
  e.environment = 0;
  e.axes = {Vec3{0, 1, 0}, Vec3{0, 0, 1}, Vec3{-1, 0, 0}};
  return s;
}

const Vec3 places[] = {{0, 0, 0}, {2.9f, 0.5f, 1.2f}, {-2, 3, 2.5f}, {2.99f, -3, 0.1f}};

// Point where the ray meets the rectangle, in [0,1]². Returns false if it misses or starts outside.
bool meets(const Vec3& x, const Vec3& wi, Vec2& at) {
  if (!(wi.x > 0) || !(x.x < 3)) return false;
  const float t = (3 - x.x) / wi.x;
  at = {(x.y + t * wi.y + 1) / 2, x.z + t * wi.z - 1};
  return at.x >= 0 && at.x <= 1 && at.y >= 0 && at.y <= 1;
}

}  // namespace

TEST_CASE("directions through a portal follow their density, from everywhere inside") {
  const double significance = sidak(1e-4, 2 * int(std::size(places)));
  for (const bool has_image : {false, true}) {
    const Scene s = with_portal(has_image);
    const LightPrimitives lights(s);
    REQUIRE(lights.size() == 1);
    for (const Vec3& x : places) {
      CAPTURE(has_image);
      CAPTURE(x.x);
      constexpr size_t n_bins = 16;
      constexpr int n = 30000, fine = 80;
      std::vector<double> observed(n_bins * n_bins), expected(n_bins * n_bins);
      Random random(3);
      for (int i = 0; i < n; ++i) {
        LightSample out;
        REQUIRE(sample(s, lights[0], x, random.next_vec2(), out));
        Vec2 at;
        const bool is_met = meets(x, out.wi, at);
        CHECK((is_met || std::abs(at.x - 0.5f) < 0.5001f));
        const size_t a = std::min(n_bins - 1, size_t(std::clamp(at.x, 0.0f, 1.0f) * n_bins));
        const size_t b = std::min(n_bins - 1, size_t(std::clamp(at.y, 0.0f, 1.0f) * n_bins));
        ++observed[b * n_bins + a];
        if (i > 500) continue;
        // The density jumps at edges of the table's cells, where a sample may lie.
        const float pdf = pdf_solid_angle(s, lights[0], x, out.wi, out.distance);
        CHECK((pdf > 0 || at.x < 1e-5f || at.x > 1 - 1e-5f || at.y < 1e-5f || at.y > 1 - 1e-5f));
        CHECK(out.radiance == radiance_beyond(s, s.lights[0], out.wi));
      }
      for (size_t b = 0; b < n_bins; ++b)
        for (size_t a = 0; a < n_bins; ++a)
          for (int i = 0; i < fine * fine; ++i) {
            const float u = (float(a) + (float(i / fine) + 0.5f) / fine) / n_bins;
            const float v = (float(b) + (float(i % fine) + 0.5f) / fine) / n_bins;
            const Vec3 way = Vec3{3, 2 * u - 1, 1 + v} - x;
            const double steradians = double(way.x) / std::pow(double(length(way)), 3) * 2 /
                                      double(n_bins * n_bins * fine * fine);
            expected[b * n_bins + a] +=
                n * steradians *
                double(pdf_solid_angle(s, lights[0], x, normalize(way),
                                       std::numeric_limits<float>::infinity()));
          }
      double total = 0;
      for (const double e : expected) total += e / n;
      CHECK(total == doctest::Approx(1).epsilon(5e-3));
      for (double& e : expected) e /= total;
      const auto r = chi_square_test(observed, expected, 1, significance);
      CHECK_MESSAGE(r.is_accepted, r.text());
    }
  }
}

TEST_CASE("an image is sampled through a portal in proportion to its visible light") {
  const Scene s = with_portal(true);
  Scene open = s;
  open.lights[0].portal.clear();
  const LightPrimitives through(s), all(open);
  const Vec3 x = places[0];
  // Estimates the integral of the luminance that the portal shows.
  const auto draw = [&](const LightPrimitive& p, double& mean, double& square) {
    Random random(9);
    constexpr int n = 20000;
    for (int i = 0; i < n; ++i) {
      LightSample out;
      Vec2 at;
      if (!sample(s, p, x, random.next_vec2(), out) || !meets(x, out.wi, at)) continue;
      const double value = double(luminance(out.radiance) / out.pdf_solid_angle);
      mean += value / n;
      square += value * value / n;
    }
  };
  double m[2] = {}, q[2] = {};
  draw(through[0], m[0], q[0]);
  draw(all[0], m[1], q[1]);
  const double v[2] = {q[0] - sqr(m[0]), q[1] - sqr(m[1])};
  CHECK(std::abs(m[0] - m[1]) < 4 * std::sqrt((v[0] + v[1]) / 20000));
  CHECK(v[0] < 0.3 * sqr(m[0]));
  CHECK(v[1] > 5 * sqr(m[1]));
}

TEST_CASE("beside a portal and behind it there is no light") {
  const Scene s = with_portal(false);
  const LightPrimitives lights(s);
  const LightPrimitive& p = lights[0];
  CHECK(radiance_at_infinity(s, p, {0, 0, 1.5f}, {1, 0, 0}) == Rgb{2});
  CHECK(radiance_at_infinity(s, p, {0, 0, 1.5f}, {-1, 0, 0}).is_black());
  CHECK(radiance_at_infinity(s, p, {0, 0, 0.5f}, {1, 0, 0}).is_black());
  CHECK(radiance_at_infinity(s, p, {4, 0, 1.5f}, {1, 0, 0}).is_black());
  CHECK(radiance_at_infinity(s, p, {4, 0, 1.5f}, {-1, 0, 0}).is_black());
  LightSample out;
  CHECK(!sample(s, p, {3, 0, 1.5f}, {0.5f, 0.5f}, out));
  CHECK(!sample(s, p, {4, 0, 1.5f}, {0.5f, 0.5f}, out));
  CHECK(pdf_solid_angle(s, p, {4, 0, 1.5f}, {1, 0, 0}, out.distance) == 0);
  // The power is what enters through the portal.
  CHECK(double(p.power) == doctest::Approx(2 * pi * 2));
}

TEST_CASE("certificates of what a portal shows to a box are never contradicted") {
  const Portal portal(window, 4, [](const Vec3&) { return 1.0f; });
  Random random(21);
  size_t proofs[3] = {};
  for (int i = 0; i < 3000; ++i) {
    const auto at = [&](float size) {
      return Vec3{random.next_float() - 0.5f, random.next_float() - 0.5f,
                  random.next_float() - 0.5f} *
             size;
    };
    Box box;
    const Vec3 middle = Vec3{2, 0, 1.5f} + at(4);
    const float size = std::pow(10.0f, -3 * random.next_float());
    for (int k = 0; k < 2; ++k) box.grow(middle + at(size));
    const Vec3d to = normalize(Vec3d(Vec3{0.5f, 0, 0} + at(1))) * 1e6;
    const double cell = 1e6 * std::pow(10.0, -3 * double(random.next_float()));
    Parallelogram far;
    far.u = Vec3d(at(1)) * cell;
    far.v = Vec3d(at(1)) * cell;
    far.origin = to - far.u * 0.5 - far.v * 0.5;
    const Portal::View view = portal.view(box, far);
    ++proofs[size_t(view)];
    if (view == Portal::View::some) continue;
    for (int k = 0; k < 50; ++k) {
      const Vec3 e = box.extent();
      const Vec3 x = box.lower + Vec3{e.x * random.next_float(), e.y * random.next_float(),
                                      e.z * random.next_float()};
      const Vec3d y =
          far.origin + far.u * double(random.next_float()) + far.v * double(random.next_float());
      CHECK(portal.shows(x, Vec3(normalize(y - Vec3d(x)))) == (view == Portal::View::all));
    }
  }
  for (const size_t n : proofs) CHECK(n > 100);
}

TEST_CASE("the frame of a portal hides everything outside its opening, within its reach") {
  const Portal portal(window, 4, [](const Vec3&) { return 1.0f; });
  constexpr double reach = 20;
  const auto frame = portal.frame(reach);
  const auto is_met = [](const Quad& q, const Vec3d& x, const Vec3d& d) {
    int left = 0, right = 0;
    for (size_t i = 0; i < 4; ++i) {
      const Vec3d a = Vec3d(q[i]) - x, b = Vec3d(q[(i + 1) % 4]) - x;
      (dot(d, cross(a, b)) > 0 ? left : right) += 1;
    }
    return left == 0 || right == 0;
  };
  Random random(8);
  int shown = 0, hidden = 0, framed = 0;
  for (int i = 0; i < 4000; ++i) {
    const auto coordinate = [&](float size) { return (random.next_float() - 0.5f) * size; };
    const Vec3 x{2.9f - 3 * random.next_float(), coordinate(6), coordinate(6)};
    const Vec3 to{3, coordinate(30), 1.5f + coordinate(30)};
    const Vec3 middle{3, coordinate(3), 1.5f + coordinate(2)};
    const Vec3 wi = normalize((i % 2 == 0 ? to : middle) - x);
    const bool is_shown = portal.shows(x, wi);
    int met = 0;
    for (const Quad& q : frame) met += is_met(q, Vec3d(x), Vec3d(wi)) ? 1 : 0;
    CAPTURE(i);
    CHECK(met == (is_shown ? 0 : 1));
    (is_shown ? shown : hidden) += 1;
    // A proof must hold for the ray in the middle, and for nearby places too.
    Box box;
    box.grow(x - Vec3{.01f});
    box.grow(x + Vec3{.01f});
    const Vec3d far = Vec3d(wi) * 1e7, u{0, 1e5, 0}, v{0, 0, 1e5};
    framed += portal.is_framed(reach, box, {far - u * 0.5 - v * 0.5, u, v, {-1, 0, 0}}) ? 1 : 0;
  }
  CHECK(shown > 500);
  CHECK(hidden > 500);
  CHECK(framed > 3000);
  Box box;
  box.grow(Vec3{2, 0, 0});
  const Vec3d past{1e6, 3e7, 0}, along{-1e5, 3e7, 0};
  for (const Vec3d& to : {past, along})
    CHECK_FALSE(portal.is_framed(reach, box, {to, {0, 1e4, 0}, {0, 0, 1e4}, {-1, 0, 0}}));
}

TEST_CASE("a sun through a portal: the part of its disc that the portal shows") {
  Scene s = with_portal(false);
  s.lights[0].kind = LightKind::sun;
  s.lights[0].direction = normalize(Vec3{-1, 0, -0.5f});
  s.lights[0].angular_radius = 0.01f;
  const LightPrimitives lights(s);
  LightSample out;
  CHECK(sample(s, lights[0], {1, 0, 0.5f}, {0.3f, 0.7f}, out));
  CHECK(out.pdf_solid_angle == doctest::Approx(1 / (pi * 1e-4)).epsilon(1e-3));
  CHECK(out.pdf_solid_angle == pdf_solid_angle(s, lights[0], {1, 0, 0.5f}, out.wi, out.distance));
  CHECK_FALSE(sample(s, lights[0], {1, 2, 0.5f}, {0.3f, 0.7f}, out));
  CHECK_FALSE(sample(s, lights[0], {4, 0, 0.5f}, {0.3f, 0.7f}, out));
}

TEST_CASE("cells of uniform light behind a portal contain all that it shows, once") {
  const Scene s = with_portal(false);
  const LightPrimitives lights(s);
  const SkyPatches cells(s, lights);
  Random random(4);
  const Portal& portal = *lights[0].portal;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 wi = normalize(
        Vec3{random.next_float(), 2 * random.next_float() - 1, 2 * random.next_float() - 1} *
        Vec3{i % 2 == 0 ? 1.0f : 0.05f, 1, 1});
    int held = 0;
    for (const SkyPatch& c : cells.all()) held += c.holds(wi) ? 1 : 0;
    CHECK(held == 1);
    CHECK(std::none_of(cells.all().begin(), cells.all().end(),
                       [&](const SkyPatch& c) { return c.holds(-wi); }));
  }
  for (const SkyPatch& c : cells.all()) {
    CHECK(c.mean == Rgb{2});
    CHECK(-dot(c.plane.normal, portal.axes()[2]) > -1e-9);
  }
}
