// Rays straight to sources behind more facets than lists are worth.
#include <doctest/doctest.h>

#include <cmath>

#include "light/irradiance.h"
#include "one_source.h"
#include "shadow/direct_rays.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// side × side level plates at height z, `part` of the area of [-size, size]² about `middle`.
std::vector<Quad> plates(int side, float size, float part, float z, float middle = 0) {
  std::vector<Quad> q;
  const float step = 2 * size / float(side), edge = step * std::sqrt(part);
  for (int i = 0; i < side * side; ++i) {
    const float x = middle - size + step * (0.1f + float(i % side)),
                y = middle - size + step * (0.1f + float(i / side));
    q.push_back({Vec3{x, y, z}, {x + edge, y, z}, {x + edge, y + edge, z}, {x, y + edge, z}});
  }
  return q;
}

double light_behind(const std::vector<Quad>& facets, const ShadowReceiver& r) {
  double sum = 0;
  for (const Quad& q : facets) {
    std::vector<Vec3d> corners;
    for (const Vec3& v : q) corners.push_back(Vec3d(v));
    sum += polygon_irradiance(corners, Vec3d(r.position), Vec3d(r.normal), Sides::both);
  }
  return sum;
}

struct Made {
  double bias = 0, rms = 0, told = 0, pixel_rms = 0, rays = 0;
};

// Four receivers are a pixel's viewing rays.
Made made_over_seeds(const FlatSource& source, const std::vector<Quad>& facets, int seeds,
                     float error) {
  BruteForceScene scene;
  scene.facets = facets;
  std::vector<ShadowReceiver> receivers = receivers_on_floor(2, 0.002f);
  CertifiedOptions options;
  options.longest_list = 2;
  options.most_halvings = 0;
  options.mask_error = error;
  options.viewing_rays = 4;
  Made made;
  const double n = double(seeds) * double(receivers.size());
  for (int seed = 0; seed < seeds; ++seed) {
    for (uint32_t i = 0; i < 4; ++i) {
      receivers[i].stream = hash_of(uint64_t(seed), i);
      receivers[i].pixel = hash_of(uint64_t(seed), 77u);
      receivers[i].sample = i;
    }
    std::vector<SourceVisibility> out(4);
    FoundFacets found;
    evaluate_alone(options, source, receivers, scene, found, out);
    REQUIRE(found.is_hopeless());
    double of_pixel = 0;
    for (size_t i = 0; i < 4; ++i) {
      const double left = double(out[i].unoccluded) - light_behind(facets, receivers[i]);
      const double error_made = double(out[i].visible) * double(out[i].unoccluded) / left - 1;
      REQUIRE(out[i].answer == ShadowAnswer::mixed);
      made.bias += error_made / n;
      made.rms += sqr(error_made) / n;
      made.told += double(out[i].variance) * sqr(double(out[i].unoccluded) / left) / n;
      made.rays += double(out[i].rays) / n;
      of_pixel += error_made / 4;
    }
    made.pixel_rms += sqr(of_pixel) / seeds;
  }
  made.rms = std::sqrt(made.rms);
  made.told = std::sqrt(made.told);
  made.pixel_rms = std::sqrt(made.pixel_rms);
  MESSAGE("bias ", made.bias, ", rms ", made.rms, ", told ", made.told, ", of a pixel ",
          made.pixel_rms, ", rays ", made.rays);
  return made;
}

}  // namespace

TEST_CASE("rays straight to a source: unbiased, and better than as many independent ones") {
  FlatSource triangle = ceiling_source();
  triangle.outline = {{0, 0}, {1, 0}, {0, 1}};
  FlatSource disk = ceiling_source();
  disk.is_disk = true;
  const FlatSource near_one{{{-2, -2, 0.3}, {4, 0, 0}, {0, 4, 0}, {0, 0, -1}}, {}};
  const auto check = [](const FlatSource& source, const std::vector<Quad>& facets, double share) {
    constexpr int seeds = 400;
    const Made made = made_over_seeds(source, facets, seeds, 0.05f);
    CHECK(std::abs(made.bias) < 4 * made.rms / std::sqrt(4.0 * seeds));
    const double random = std::sqrt((1 - share) / share / made.rays);
    CHECK(made.rms < 0.9 * random);
    CHECK(made.pixel_rms < 0.6 * made.rms);
    CHECK(2 * made.pixel_rms < made.told);
    CHECK(made.told < 2.5 * 2 * made.pixel_rms);
  };
  check(ceiling_source(), plates(8, 0.2f, 0.5f, 1), 0.5);
  check(triangle, plates(4, 0.05f, 0.3f, 0.8f, -0.06f), 0.9);
  check(disk, plates(5, 0.12f, 0.4f, 1), 0.8);
  check(near_one, plates(4, 0.1f, 0.6f, 0.1f), 0.7);
}

TEST_CASE(
    "rays straight to a source: where nothing hides it, what is learnt takes the noise away") {
  const FlatSource source = ceiling_source();
  BruteForceScene scene;
  scene.facets = plates(8, 5, 0.0001f, 1.2f);  // all but open
  OneSource one(receivers_on_floor(8, 0.01f));
  one.options.longest_list = 0;
  one.options.most_halvings = 0;
  std::vector<SourceVisibility> out(64);
  for (int time = 0; time < 2; ++time)
    evaluate_alone(one.options, source, one.receivers, scene, one.found, out);
  for (const SourceVisibility& a : out)
    CHECK(double(a.visible) == doctest::Approx(1).epsilon(2e-2));
}

TEST_CASE("rays straight to a source: spread so that fewer keep the error of all") {
  Random r(3);
  FoundFacets::Dense dense;
  CHECK(dense.spread(20) == 20);  // nothing is known yet
  double wanted = 0, cast = 0, square = 0;
  constexpr int clusters = 4000;
  for (int i = 0; i < clusters; ++i) {
    const double rays = std::exp(4 * r.next_double());  // where each is to err as asked
    dense.note_wanted(64, rays);
    const double n = dense.spread(rays);
    CHECK(n >= 0.25 * rays);
    wanted += rays;
    cast += n;
    square += rays / n;  // squared error, in what is asked
  }
  CHECK(square / clusters == doctest::Approx(1).epsilon(0.1));
  CHECK(cast < 0.85 * wanted);
}
