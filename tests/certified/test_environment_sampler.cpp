// EnvironmentSampler: sampled points of skies and images are unbiased, and proportional to their
// light.
#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "base/random.h"
#include "base/units.h"
#include "base/warp.h"
#include "certified/environment_sampler.h"
#include "light/light.h"
#include "light/sky_patches.h"
#include "support/light_scenes.h"
#include "support/surfaceless_lights.h"

using namespace troffer;
using namespace troffer::test;

namespace {

enum class Kind { overcast, clear, image, sunny };

Scene under(Kind kind) {
  Scene s;
  add_quad(s, add_diffuse(s, Rgb{0.5f}), {Vec3{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
  if (kind == Kind::image || kind == Kind::sunny) {
    const bool is_sunny = kind == Kind::sunny;
    EnvironmentMap map;
    map.width = is_sunny ? 256 : 64;
    map.height = map.width / 2;
    for (int i = 0; i < map.width * map.height; ++i)
      map.texels.push_back(Rgb{1 + std::sin(0.1f * float(i % map.width))});
    // A sun of 4 degrees over a uniform image without ground.
    for (int i = 0; is_sunny && i < map.width * map.height; ++i) {
      const double altitude = 90 - 180 * (i / map.width + 0.5) / map.height;
      const double azimuth = 360 * (i % map.width + 0.5) / map.width - 180;
      map.texels[size_t(i)] = Rgb{std::hypot(altitude - 35, azimuth - 30) < 2 ? 5e4f : 40.0f};
    }
    s.environments.push_back(map);
    add_light(s, LightKind::environment, Rgb{1}).environment = 0;
    return s;
  }
  Light& e = add_light(s, LightKind::sky, Rgb{1});
  e.direction = normalize(Vec3{-0.6f, -0.5f, -0.7f});
  if (kind == Kind::overcast) {
    e.sky.a = 4;
    e.sky.b = -0.7f;
  } else {
    e.sky.a = -1;
    e.sky.b = -0.32f;
    e.sky.c = 10;
    e.sky.d = -3;
    e.sky.e = 0.45f;
  }
  e.sky.ground = Rgb{0.2f};
  return s;
}

struct Points {
  Scene scene;
  LightPrimitives lights;
  SkyPatches cells;
  std::vector<CertifiedSource> sources;
  EnvironmentSampler points;

  explicit Points(Kind kind) : scene(under(kind)), lights(scene), cells(scene, lights) {
    for (const SkyPatch& cell : cells.all()) {
      CertifiedSource source;
      source.flat.plane = cell.plane;
      source.radiance = cell.mean;
      source.is_textured = !cell.is_even;
      source.primitive = cell.primitive;
      source.far = &cell;
      sources.push_back(source);
    }
    points = EnvironmentSampler(sources);
  }
};

// Unoccluded irradiance of a surface, by cosine-distributed points of the hemisphere in `frame`.
double expected(const Points& p, const Frame& frame) {
  constexpr int n = 600;
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const Vec2 u{(float(i) + 0.5f) / n, (float(j) + 0.5f) / n};
      const Vec3 wi = frame.to_world(cosine_hemisphere_from_square(u));
      sum += double(luminance(radiance_beyond(p.scene, p.scene.lights[0], wi)));
    }
  return sum * pi / (double(n) * n);
}

// Mean and root mean square error of several runs of n samples, relative to the expected value.
struct Estimates {
  double mean = 0, error = 0;
};
Estimates estimates_of(const Points& p, const EnvironmentSampler::Chances& chances,
                       const Vec3& normal, size_t n, int runs) {
  const double whole = expected(p, Frame(normal));
  double mean = 0, squares = 0;
  for (int run = 0; run < runs; ++run) {
    const std::vector<uint64_t> streams(n, hash_of(uint64_t(run), 5u));
    std::vector<uint32_t> samples;
    for (uint32_t j = 0; j < n; ++j) samples.push_back(j);
    std::vector<float> u(2 * n);
    sobol_groups(streams.data(), samples.data(), n, 0, 2, u.data());
    double sum = 0;
    for (size_t j = 0; j < n; ++j) {
      const EnvironmentSampler::Point at =
          p.points.point(p.points.choose(chances, u[j], u[n + j]), normal);
      if (at.source == nullptr) continue;
      sum += double(luminance(far_radiance_of(*at.source, at.way)) *
                    std::max(dot(at.wi, normal), 0.0f) * at.inverse_pdf) /
             double(n);
    }
    mean += sum / runs;
    squares += sqr(sum / whole - 1) / runs;
  }
  return {mean / whole, std::sqrt(squares)};
}

}  // namespace

TEST_CASE("64 points of a sky give the unoccluded light") {
  for (const Kind kind : {Kind::overcast, Kind::clear, Kind::image}) {
    const Points p(kind);
    for (const Vec3& normal : {Vec3{0, 0, 1}, normalize(Vec3{0.4f, -0.7f, 0.6f})}) {
      ShadowReceiver r{};
      r.normal = r.horizon = normal;
      EnvironmentSampler::Chances chances;
      REQUIRE(p.points.set_chances(r, chances));
      constexpr int runs = 256;
      const Estimates e = estimates_of(p, chances, normal, 64, runs);
      CAPTURE(int(kind));
      CAPTURE(normal.z);
      CHECK(std::abs(e.mean - 1) < 0.002 + 4 * e.error / std::sqrt(double(runs)));
      CHECK(e.error < 0.015);
    }
  }
}

// Precomputed chances must serve every normal in their neighbourhood: no visible part has zero
// chance, and the error hardly grows.
TEST_CASE("probabilities for normals near a receiver's leave none of its light out") {
  for (const Kind kind : {Kind::overcast, Kind::clear, Kind::image}) {
    const Points p(kind);
    Random random(7 + uint64_t(kind));
    for (int k = 0; k < 12; ++k) {
      Vec3 normal = sphere_from_square(random.next_vec2());
      if (k < 3) normal = {0, 0, k == 0 ? -1.0f : 1.0f};  // centre of a cube face
      if (k == 2) normal = normalize(Vec3{1, 1, 1});      // corner of a cube face
      ShadowReceiver r{};
      r.normal = r.horizon = normal;
      EnvironmentSampler::Chances own;
      REQUIRE(p.points.set_chances(r, own));
      const EnvironmentSampler::Chances& about = p.points.chances_about(normal);
      for (int j = 0; j < 2000; ++j) {
        const Vec2 u = random.next_vec2();
        const EnvironmentSampler::Choice c = p.points.choose(own, u.x, u.y);
        const float chance = p.points.chance_of(about, c.part);
        REQUIRE(chance * about.all() >= 0.499f * c.chance * own.all());
      }
      constexpr int runs = 128;
      const Estimates e = estimates_of(p, about, normal, 16, runs);
      CAPTURE(int(kind));
      CAPTURE(k);
      CHECK(std::abs(e.mean - 1) < 0.003 + 4 * e.error / std::sqrt(double(runs)));
      CHECK(e.error < 0.12);
    }
  }
}

// A dim part with a few bright texels must not be sampled by its typical luminance. Parts are cut
// until they are even, so samples have similar values with or without a sun.
TEST_CASE("no point of an image with a small sun has a weight far above all light") {
  const Points p(Kind::sunny);
  Random random(11);
  for (const Vec3& normal : {Vec3{0, 0, 1}, normalize(Vec3{0.3f, 0.5f, 0.4f})}) {
    ShadowReceiver r{};
    r.normal = r.horizon = normal;
    EnvironmentSampler::Chances own;
    REQUIRE(p.points.set_chances(r, own));
    for (const EnvironmentSampler::Chances* chances :
         std::array<const EnvironmentSampler::Chances*, 2>{&own, &p.points.chances_about(normal)}) {
      double mean = 0, most = 0;
      constexpr int n = 200'000;
      for (int j = 0; j < n; ++j) {
        const Vec2 u = random.next_vec2();
        const EnvironmentSampler::Point at =
            p.points.point(p.points.choose(*chances, u.x, u.y), normal);
        if (at.source == nullptr) continue;
        const double value = double(luminance(far_radiance_of(*at.source, at.way)) *
                                    std::max(dot(at.wi, normal), 0.0f) * at.inverse_pdf);
        mean += value / n;
        most = std::max(most, value);
      }
      CAPTURE(normal.z);
      CHECK(mean == doctest::Approx(expected(p, Frame(normal))).epsilon(0.02));
      CHECK(most < 3 * mean);
      constexpr int runs = 128;
      const Estimates e = estimates_of(p, *chances, normal, 64, runs);
      CAPTURE(e.error);
      CHECK(e.error < 0.02);
    }
  }
}
