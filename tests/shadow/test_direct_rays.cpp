// Tests of direct rays: sources behind more facets than lists are worth.
#include <doctest/doctest.h>

#include <cmath>

#include "light/irradiance.h"
#include "one_source.h"
#include "shadow/direct_rays.h"

using namespace troffer;
using namespace troffer::test;

namespace test_direct_rays {

namespace {

// Returns side × side level plates at height z, which cover `part` of [-size, size]² around
// `middle`.
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

// Measures errors over seeds. The four receivers are the viewing rays of one pixel.
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
    REQUIRE(found.is_over_budget());
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

// Returns the visible share of the source's light by rays on a fine grid, or a negative value if no
// light can arrive.
double share_by_brute_force(const FlatSource& source, const BruteForceScene& scene,
                            const ShadowReceiver& r) {
  constexpr int side = 300;
  double all = 0, open = 0;
  for (int i = 0; i < side * side; ++i) {
    const double u = (0.5 + i % side) / side, v = (0.5 + double(i / side)) / side;
    const Vec3d y = source.plane.origin + source.plane.u * u + source.plane.v * v;
    const Vec3d d = y - Vec3d(r.position);
    const double cosines = dot(Vec3d(r.normal), d) * -dot(source.plane.normal, d);
    if (!(dot(Vec3d(r.normal), d) > 0)) continue;
    const double weight = cosines / sqr(length_squared(d));
    all += weight;
    if (scene.is_hidden(Vec3d(r.origin), y, 0) != 1) open += weight;
  }
  return all > 0 ? open / all : -1;
}

}  // namespace

TEST_CASE("direct rays: unbiased, and better than as many independent ones") {
  FlatSource triangle = ceiling_source();
  triangle.outline = {{0, 0}, {1, 0}, {0, 1}};
  FlatSource disk = ceiling_source();
  disk.is_disk = true;
  const FlatSource near_one{{{-2, -2, 0.3}, {4, 0, 0}, {0, 4, 0}, {0, 0, -1}}, {}};
  const auto check = [](const FlatSource& source, const std::vector<Quad>& facets, double share,
                        float error = 0.05f, double rays = 256) {
    constexpr int seeds = 400;
    const Made made = made_over_seeds(source, facets, seeds, error);
    CHECK(made.rays == doctest::Approx(rays));
    CHECK(std::abs(made.bias) < 4 * made.rms / std::sqrt(4.0 * seeds));
    const double random = std::sqrt((1 - share) / share / made.rays);
    CHECK(made.rms < 0.9 * random);
    CHECK(made.pixel_rms < 0.6 * made.rms);
    CHECK(2 * made.pixel_rms < made.told);
    CHECK(made.told < 2 * 2 * made.pixel_rms);
  };
  check(ceiling_source(), plates(8, 0.2f, 0.5f, 1), 0.5);
  // three blocks of 32 per viewing ray
  check(ceiling_source(), plates(8, 0.2f, 0.5f, 1), 0.5, 0.09f, 96);
  check(triangle, plates(4, 0.05f, 0.3f, 0.8f, -0.06f), 0.9);
  check(disk, plates(5, 0.12f, 0.4f, 1), 0.8);
  check(near_one, plates(4, 0.1f, 0.6f, 0.1f), 0.7);
}

// All receivers share one estimate of the open share (here one half), but the mean of each must be
// right. Where everything is hidden the mean is 0, so about half of the answers are negative.
TEST_CASE("direct rays: no bias where little or nothing is open") {
  constexpr int seeds = 1500, count = 16;
  const FlatSource source = ceiling_source();
  BruteForceScene scene;
  scene.facets = plates(8, 0.45f, 1.0f, 1, 0.35f);  // two layers without a gap
  for (const Quad& q : plates(7, 0.45f, 1.0f, 1.01f, 0.35f)) scene.facets.push_back(q);
  std::vector<ShadowReceiver> receivers = receivers_on_floor(4, 0.25f);
  for (size_t i = 0; i < count; i += 3)  // some see the source low over their horizon
    receivers[i].normal = receivers[i].horizon =
        normalize(Vec3{-1, -0.2f, i % 2 == 0 ? 0.3f : -0.1f});
  CertifiedOptions options;
  options.mask_error = 0.1f;
  double sums[count] = {}, squares[count] = {};
  bool is_any_negative = false;
  for (uint64_t seed = 0; seed < seeds; ++seed) {
    for (uint32_t i = 0; i < count; ++i) receivers[i].stream = hash_of(seed, i, 5u);
    std::vector<SourceVisibility> out(count);
    FoundFacets found;
    found.dense.open_share = 0.5;
    found.dense.rays = 16;
    found.note_over_budget({}, 1);
    evaluate_alone(options, source, receivers, scene, found, out);
    for (size_t i = 0; i < count; ++i) {
      if (out[i].answer == ShadowAnswer::below) continue;
      const auto share = double(out[i].visible);
      REQUIRE(out[i].rays == 16);
      sums[i] += share;
      squares[i] += sqr(share);
      is_any_negative = is_any_negative || share < 0;
    }
  }
  CHECK(is_any_negative);
  int hidden = 0, partly = 0;
  for (size_t i = 0; i < count; ++i) {
    const double right = share_by_brute_force(source, scene, receivers[i]);
    if (right < 0) continue;
    const double mean = sums[i] / seeds;
    const double error = std::sqrt((squares[i] / seeds - sqr(mean)) / (seeds - 1));
    hidden += right == 0 ? 1 : 0;
    partly += right > 0 && right < 1 ? 1 : 0;
    CAPTURE(i);
    CHECK(std::abs(mean - right) < 4.5 * error + 1e-4);
  }
  CHECK(hidden >= 3);
  CHECK(partly >= 3);
}

TEST_CASE("direct rays: in the open, what is learnt removes the noise") {
  const FlatSource source = ceiling_source();
  BruteForceScene scene;
  scene.facets = plates(8, 5, 0.0001f, 1.2f);  // almost everything is open
  OneSource one(receivers_on_floor(8, 0.01f));
  one.options.longest_list = 0;
  one.options.most_halvings = 0;
  std::vector<SourceVisibility> out(64);
  for (int time = 0; time < 2; ++time)
    evaluate_alone(one.options, source, one.receivers, scene, one.found, out);
  for (const SourceVisibility& a : out)
    CHECK(double(a.visible) == doctest::Approx(1).epsilon(2e-2));
}

TEST_CASE("direct rays: the same number for a whole batch, by its error and share") {
  OneSource one(receivers_on_floor(8, 0.01f));
  BruteForceScene scene;
  scene.facets = plates(24, 0.4f, 0.5f, 1);
  std::vector<float> none(one.receivers.size(), 0), others(one.unoccluded.size());
  const auto rays_at = [&](float error, float times) {
    for (size_t i = 0; i < others.size(); ++i) others[i] = times * one.unoccluded[i];
    SourceTask task = one.task();
    task.promise.error = error;
    task.promise.seen = task.promise.floor = none;
    task.promise.rest = others;
    return direct_rays_of(task, scene);
  };
  one.options.rays.most_direct_rays = 4096;
  const double n = rays_at(0.1f, 0);
  CHECK(one.found.dense.open_share > 0.3);
  CHECK(one.found.dense.open_share < 0.7);
  CHECK(scene.segments > 0);
  const uint64_t pilots = scene.segments;
  CHECK(rays_at(0.05f, 0) == n);  // from another cluster of the batch
  CHECK(scene.segments == pilots);
  one.found = {};
  CHECK(rays_at(0.05f, 0) == doctest::Approx(4 * n).epsilon(1e-5));
  one.found = {};
  CHECK(rays_at(0.05f, 1) == doctest::Approx(2 * n).epsilon(1e-5));
  // the visible share of a weak source deserves some rays, too
  one.found = {};
  CHECK(rays_at(0.1f, 1000) == 64);
  one.options.rays.pair_error = 0.1f;
  one.found = {};
  CHECK(rays_at(0.1f, 1000) == doctest::Approx(25).epsilon(1e-5));
}

TEST_CASE("direct rays: where clutter leaves much open, nothing else is tried") {
  OneSource one(receivers_on_floor(12, 0.01f));
  BruteForceScene scene;
  const auto gathers_behind = [&](const std::vector<Quad>& facets) {
    scene.facets = facets;
    one.found = {};
    one.counters = {};
    one.options.longest_list = 100;
    std::vector<float> none(one.receivers.size(), 0);
    SourceTask task = one.task();
    task.promise.error = 0.05f;
    task.promise.seen = task.promise.rest = task.promise.floor = none;
    GatherMemory memory;
    std::vector<uint32_t> members = one.members;
    const ReceiverHull hull = hull_of(one.cluster, members);
    divide_flat(task, members, hull, visible_part(one.source, hull), scene, memory, one.counters);
    return std::pair(one.counters.gathers, memory.parts.all().size());
  };
  // plates that hide half of the source: given up at once, as one part
  CHECK(gathers_behind(plates(24, 0.4f, 0.5f, 1)) == std::pair<uint64_t, size_t>(1, 1));
  // the same in front of a sheet, which may be proved dark: halves are examined
  std::vector<Quad> closed = plates(24, 0.4f, 0.5f, 1);
  closed.push_back(parallelogram_facet({-2, -2, 1.1f}, {4, 0, 0}, {0, 4, 0}));
  CHECK(gathers_behind(closed).first > 1);
}

}  // namespace test_direct_rays
