#include <doctest/doctest.h>

#include <bit>
#include <cmath>

#include "brute_force.h"
#include "light/irradiance.h"
#include "shadow/receiver_clusters.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// Returns the visible share by a fine grid over the source, weighted by irradiance.
double reference_share(const BruteForceScene& scene, const FlatSource& s, const ShadowReceiver& x,
                       int n) {
  double all = 0, seen = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double u = (i + 0.5) / n, v = (j + 0.5) / n;
      if (!s.outline.empty() && u + v > 1) continue;
      const Vec3d y = s.plane.origin + s.plane.u * u + s.plane.v * v;
      const Vec3d d = y - Vec3d(x.position);
      const double w = std::max(0.0, dot(d, Vec3d(x.normal))) / std::pow(length_squared(d), 2);
      all += w;
      if (w > 0 && scene.is_hidden(Vec3d(x.origin), y, 0) != 1) seen += w;
    }
  return all > 0 ? seen / all : 0;
}

ShadowReceiver receiver(const Vec3& p, const Vec3& n, uint64_t stream) {
  return {p, n, n, p + n * 4e-6f, stream};
}

}  // namespace

TEST_CASE("visible shares against a grid of rays on random scenes") {
  double error2 = 0, mean = 0, predicted2 = 0;
  int pairs = 0;
  for (uint64_t seed = 0; seed < 150; ++seed) {
    Random r(seed + 31);
    BruteForceScene scene;
    const FlatSource source = random_source(r);
    add_random_facets(r, scene);
    const std::vector<ShadowReceiver> receivers = random_receivers(r, 4);
    CertifiedOptions options;
    options.lattice = fine_lattice;
    FoundFacets found;
    std::vector<SourceVisibility> out(receivers.size());
    evaluate_alone(options, source, receivers, scene, found, out);
    for (size_t i = 0; i < receivers.size(); ++i) {
      if (out[i].unoccluded < 1e-4f) continue;
      const double e = double(out[i].visible) - reference_share(scene, source, receivers[i], 60);
      error2 += e * e;
      predicted2 += double(out[i].variance);
      mean += e;
      ++pairs;
    }
  }
  CHECK(pairs > 300);
  CHECK(std::sqrt(error2 / pairs) < 0.006);
  CHECK(std::abs(mean / pairs) < 0.001);
  // Close to large sources, where weights vary most within a cell, the estimated error may be less
  // than the actual one.
  CHECK(error2 < 2 * predicted2);
  CHECK(predicted2 < 6 * error2);
  MESSAGE("rms error ", std::sqrt(error2 / pairs), ", told ", std::sqrt(predicted2 / pairs));
}

TEST_CASE("visible shares are unbiased over seeds, with complete masks and with rays") {
  const FlatSource source{{{-0.8, -0.7, 2}, {1.5, 0, 0}, {0.2, 1.4, 0}, {0, 0, -1}}, {}};
  BruteForceScene scene;
  scene.facets = {parallelogram_facet({0.1f, -0.4f, 1.1f}, {0.7f, 0.1f, 0.05f}, {-0.1f, 0.6f, 0}),
                  parallelogram_facet({-0.5f, -0.5f, 0.6f}, {0.02f, 0, 0}, {0.1f, 0.9f, 0.3f}),
                  parallelogram_facet({-0.2f, 0.1f, 1.9f}, {0.2f, 0, 0.1f}, {0, 0.2f, 0.2f})};
  const ShadowReceiver x = receiver({0.05f, -0.1f, 0}, normalize(Vec3{0.2f, 0.1f, 1}), 0);
  const double expected = reference_share(scene, source, x, 1500);
  REQUIRE(expected > 0.2);
  REQUIRE(expected < 0.9);
  for (const bool is_complete : {true, false}) {
    for (const MaskLattice& lattice : {coarse_lattice, fine_lattice}) {
      CertifiedOptions options;
      options.lattice = lattice;
      options.longest_list = is_complete ? 64 : 1;  // one facet is known, rays decide two
      options.most_halvings = 0;
      options.rays.most_rays = options.rays.most_pair_rays = 4;
      double sum = 0, sum2 = 0, bound = 0;
      constexpr int seeds = 4000;
      for (int i = 0; i < seeds; ++i) {
        FoundFacets found;
        ShadowReceiver here = x;
        here.stream = hash_of(uint64_t(i), 5u);
        SourceVisibility out;
        evaluate_alone(options, source, {&here, 1}, scene, found, {&out, 1});
        CHECK(out.answer == (is_complete ? ShadowAnswer::masked : ShadowAnswer::mixed));
        sum += double(out.visible);
        sum2 += double(out.visible) * double(out.visible);
        bound += double(out.variance);
      }
      const double mean = sum / seeds, variance = sum2 / seeds - mean * mean;
      CHECK(std::abs(mean - expected) < 4 * std::sqrt(variance / seeds) + 2e-4);
      if (!is_complete) CHECK(variance <= bound / seeds);
      MESSAGE(lattice.samples(), " samples, ", is_complete ? "complete" : "with rays", ": ",
              std::sqrt(variance), " against ", std::sqrt(bound / seeds));
    }
  }
}

TEST_CASE("unoccluded light is exact and needs no ray") {
  BruteForceScene scene;
  scene.facets = {parallelogram_facet({5, 5, 1}, {1, 0, 0}, {0, 1, 0})};
  Random r(3);
  for (int i = 0; i < 100; ++i) {
    const FlatSource source = random_source(r);
    std::vector<ShadowReceiver> receivers = random_receivers(r, 8);
    std::vector<SourceVisibility> out(receivers.size());
    const CertifiedOptions options;
    FoundFacets found;
    evaluate_alone(options, source, receivers, scene, found, out);
    for (size_t k = 0; k < out.size(); ++k) {
      const double expected = polygon_irradiance(source.corners(), Vec3d(receivers[k].position),
                                                 Vec3d(receivers[k].normal), Sides::both);
      if (out[k].answer == ShadowAnswer::below) continue;
      CHECK(double(out[k].unoccluded) == doctest::Approx(expected).epsilon(1e-5));
      CHECK(out[k].visible == 1);
    }
  }
  CHECK(scene.segments == 0);
}

TEST_CASE("a light set into a ceiling is not hidden by it, nor by itself; a shade hides it") {
  const FlatSource source{{{-0.5, -0.5, 3}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}}, {}};
  BruteForceScene scene;
  scene.facets = {parallelogram_facet({-0.5f, -0.5f, 3}, {1, 0, 0}, {0, 1, 0}),  // the light
                  parallelogram_facet({-4, -4, 3}, {8, 0, 0}, {0, 8, 0}),        // the ceiling
                  parallelogram_facet({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}),        // the floor
                  parallelogram_facet({-4, -4, 0}, {8, 0, 0}, {0, 0, 3})};       // a wall
  std::vector<ShadowReceiver> receivers;
  for (int i = 0; i < 64; ++i)
    receivers.push_back(
        receiver({float(i % 8) * 0.1f, float(i / 8) * 0.1f, 0}, {0, 0, 1}, uint64_t(i)));
  std::vector<SourceVisibility> out(receivers.size());
  const CertifiedOptions options;
  FoundFacets found;
  evaluate_alone(options, source, receivers, scene, found, out);
  for (const SourceVisibility& v : out) CHECK(v.answer == ShadowAnswer::lit);
  scene.facets.push_back(parallelogram_facet({-0.6f, -0.6f, 2.99f}, {1.2f, 0, 0}, {0, 1.2f, 0}));
  evaluate_alone(options, source, receivers, scene, found, out);
  for (const SourceVisibility& v : out) CHECK(v.answer == ShadowAnswer::dark);
}

TEST_CASE("thin occluders: none missed, mean error within 0.3 % of the unoccluded value") {
  const FlatSource source{{{-0.5, -0.5, 3}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}}, {}};
  const auto mean_error = [&](BruteForceScene& scene) {
    std::vector<ShadowReceiver> receivers;
    for (int i = 0; i < 64; ++i)
      receivers.push_back(receiver({0.02f + float(i % 8) * 0.03f, float(i / 8) * 0.03f, 0},
                                   {0, 0, 1}, hash_of(uint64_t(i), 1u)));
    std::vector<SourceVisibility> out(receivers.size());
    const CertifiedOptions options;
    FoundFacets found;
    evaluate_alone(options, source, receivers, scene, found, out);
    double error = 0;
    for (size_t i = 0; i < out.size(); ++i) {
      CHECK(out[i].answer == ShadowAnswer::masked);
      if (i % 16 == 0)
        error += (double(out[i].visible) - reference_share(scene, source, receivers[i], 400)) / 4;
    }
    return std::abs(error);
  };
  BruteForceScene wire;
  wire.facets = {parallelogram_facet({-2, 0.1f, 1.5f}, {4, 0.3f, 0}, {0, 0.001f, 0})};
  CHECK(mean_error(wire) < 0.003);
  BruteForceScene comb;
  for (int i = 0; i < 64; ++i)
    comb.facets.push_back(
        parallelogram_facet({-1 + float(i) / 32, -1, 1.2f}, {1.0f / 64, 0, 0}, {0, 2, 0}));
  CHECK(mean_error(comb) < 0.006);
  BruteForceScene speck;
  speck.facets = {parallelogram_facet({0, 0, 1.5f}, {0.01f, 0, 0}, {0, 0.01f, 0})};
  CHECK(mean_error(speck) < 0.003);
}

TEST_CASE("for segments outside of closed surfaces the front facets are enough") {
  size_t compared = 0, hidden = 0;
  for (uint64_t seed = 0; seed < 200; ++seed) {
    Random r(seed + 5);
    const FlatSource source{{{-0.8, -0.7, 2}, {1.5, 0, 0}, {0.2, 1.4, 0}, {0, 0, -1}}, {}};
    std::vector<FacetToAdd> all, front;
    for (int i = 0; i < 4; ++i) {  // boxes, turned at random
      const Vec3 c = random_vector(r, 0.5f) + Vec3{0, 0, 1};
      const Vec3 x = random_vector(r, 0.2f), y0 = random_vector(r, 0.2f);
      const Vec3 z = cross(normalize(x), normalize(y0)) * 0.1f, y = cross(z, x) * 2.0f;
      for (const bool is_upper : {false, true})
        for (int axis = 0; axis < 3; ++axis) {
          const Vec3 a = axis == 0 ? x : axis == 1 ? y : z;
          const Vec3 u = axis == 0 ? y : axis == 1 ? z : x;
          const Vec3 v = axis == 0 ? z : axis == 1 ? x : y;
          const Vec3 corner = c + (is_upper ? a : Vec3{0, 0, 0});
          Quad q = parallelogram_facet(corner, u, v);  // normal along a
          if (!is_upper) std::swap(q[1], q[3]);
          all.push_back({q, 0, false});
          front.push_back({q, 0, true});
        }
    }
    const MaskFrame frame(source.plane, fine_lattice, seed % 2 == 1, {0, 0, 0});
    FacetList a, b;
    a.add_many(frame, all);
    b.add_many(frame, front);
    a.finish();
    b.finish();
    CoverageMask with, without;
    const Vec3 x = frame.to_canvas({0.3 * r.next_double(), 0.3 * r.next_double(), -0.1});
    const Vec2 shift = r.next_vec2();
    cover(frame, a, x, shift, with);
    cover(frame, b, x, shift, without);
    for (size_t row = 0; row < most_mask_rows; ++row)
      for (uint32_t k = 0; k < 31; ++k) {
        if ((with.inside.row[row] >> k & 1u) == 0) continue;
        ++compared;
        hidden += (with.open.row[row] >> k & 1u) == 0;
        // a sample within rounding of an outline may differ
        if ((with.open.row[row] >> k & 1u) != (without.open.row[row] >> k & 1u)) --hidden;
        CHECK((with.open.row[row] >> k & 1u) <= (without.open.row[row] >> k & 1u));
      }
    int differ = 0;
    for (size_t row = 0; row < most_mask_rows; ++row)
      differ += std::popcount(with.open.row[row] ^ without.open.row[row]);
    CHECK(differ <= 1);
  }
  CHECK(compared > 100000);
  CHECK(hidden > 5000);
}

TEST_CASE("a receiver with a geometric and a shading normal loses the light behind either") {
  const FlatSource source{{{0.2, -0.5, 0.1}, {0, 1, 0}, {0, 0, 1.2}, {-1, 0, 0}}, {}};
  BruteForceScene scene;
  scene.facets = {parallelogram_facet({0.1f, -0.1f, 0.2f}, {0, 0.2f, 0}, {0, 0, 0.3f})};
  ShadowReceiver x = receiver({0, 0, 0}, normalize(Vec3{0.4f, 0, 1}), 3);
  x.normal = normalize(Vec3{-0.3f, 0.1f, 1});
  double all = 0, seen = 0;
  constexpr int n = 1500;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const Vec3d y =
          source.plane.origin + source.plane.u * ((i + 0.5) / n) + source.plane.v * ((j + 0.5) / n);
      if (dot(y, Vec3d(x.horizon)) <= 0 || dot(y, Vec3d(x.normal)) <= 0) continue;
      const double w =
          dot(y, Vec3d(x.normal)) * y.x / std::pow(length_squared(y), 2) * 1.2 / (n * n);
      all += w;
      if (scene.is_hidden(Vec3d(x.origin), y, 0) != 1) seen += w;
    }
  CertifiedOptions options;
  options.lattice = fine_lattice;
  double unoccluded = 0, visible = 0;
  constexpr int seeds = 200;
  for (int i = 0; i < seeds; ++i) {
    FoundFacets found;
    SourceVisibility out;
    x.stream = hash_of(uint64_t(i), 9u);
    evaluate_alone(options, source, {&x, 1}, scene, found, {&out, 1});
    unoccluded = double(out.unoccluded);
    visible += double(out.visible) / seeds;
  }
  CHECK(unoccluded == doctest::Approx(all).epsilon(1e-3));
  CHECK(visible == doctest::Approx(seen / all).epsilon(2e-3));
}

TEST_CASE(
    "near a large source: source cells keep shares exact where weights vary by orders of "
    "magnitude") {
  const FlatSource source{{{-2, -2, 0.15}, {4, 0, 0}, {0, 4, 0}, {0, 0, -1}}, {}};
  BruteForceScene scene;
  scene.facets = {parallelogram_facet({0.02f, -0.1f, 0.05f}, {0.1f, 0.02f, 0.01f}, {0, 0.2f, 0}),
                  parallelogram_facet({-1.5f, -1, 0.1f}, {1, 0, 0}, {0, 1, 0})};
  std::vector<ShadowReceiver> receivers;
  for (int i = 0; i < 16; ++i)
    receivers.push_back(receiver({0.02f * float(i % 4), 0.02f * float(i / 4), 0}, {0, 0, 1},
                                 hash_of(uint64_t(i), 1u)));
  std::vector<SourceVisibility> out(receivers.size());
  CertifiedOptions options;
  options.lattice = fine_lattice;
  FoundFacets found;
  const CertifiedCounters counters = evaluate_alone(options, source, receivers, scene, found, out);
  CHECK(counters.cells > 4);
  double error2 = 0;
  for (size_t i = 0; i < out.size(); ++i) {
    const double e = double(out[i].visible) - reference_share(scene, source, receivers[i], 1200);
    error2 += e * e / double(out.size());
  }
  CHECK(std::sqrt(error2) < 0.004);
}

TEST_CASE("disks: exact where unoccluded, else masked by a circle of samples") {
  FlatSource source{{{-0.5, -0.5, 2}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}}, {}, true};
  BruteForceScene scene;
  scene.facets = {parallelogram_facet({0, -3, 1}, {3, 0, 0}, {0, 6, 0})};
  std::vector<ShadowReceiver> receivers{receiver({0, 0, 0}, {0, 0, 1}, 7),
                                        receiver({-2, 0, 0}, {0, 0, 1}, 8),
                                        receiver({2, 0, 0}, {0, 0, 1}, 9)};
  double half = 0;
  for (uint64_t i = 0; i < 400; ++i) {
    for (size_t k = 0; k < 3; ++k) receivers[k].stream = hash_of(i, k);
    std::vector<SourceVisibility> out(3);
    const CertifiedOptions options;
    FoundFacets found;
    evaluate_alone(options, source, receivers, scene, found, out);
    half += double(out[0].visible) / 400;
    CHECK(double(out[0].unoccluded) ==
          doctest::Approx(disk_irradiance({0, 0, 2}, {0, 0, -1}, 0.5, {0, 0, 0}, {0, 0, 1})));
    CHECK(out[1].visible == 1);
    CHECK(out[2].visible == 0);
  }
  CHECK(half == doctest::Approx(0.5).epsilon(2e-3));
}

TEST_CASE("a disk cut by a receiver's horizon sends the light of the part above it") {
  const FlatSource source{{{0.2, -0.5, -0.3}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}}, {}, true};
  ShadowReceiver x = receiver({0, 0, 0}, normalize(Vec3{0.4f, 0, 1}), 3);
  x.normal = normalize(Vec3{-0.3f, 0.1f, 1});
  for (const Vec3& horizon : {normalize(Vec3{0.4f, 0, 1}), normalize(Vec3{-0.6f, 0, 1})}) {
    x.horizon = horizon;
    for (const bool is_hidden : {false, true}) {
      BruteForceScene scene;
      if (is_hidden)
        scene.facets = {parallelogram_facet({0.1f, -0.1f, 0}, {0, 0.2f, 0}, {0, 0, 0.3f})};
      double expected = 0;
      constexpr int n = 1500;
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const double u = (i + 0.5) / n, v = (j + 0.5) / n;
          const Vec3d y = source.plane.origin + source.plane.u * u + source.plane.v * v;
          if (sqr(u - 0.5) + sqr(v - 0.5) > 0.25) continue;
          if (dot(y, Vec3d(x.horizon)) <= 0 || dot(y, Vec3d(x.normal)) <= 0) continue;
          if (scene.is_hidden(Vec3d(x.origin), y, 0) == 1) continue;
          expected += dot(y, Vec3d(x.normal)) * y.x / std::pow(length_squared(y), 2) / (n * n);
        }
      CertifiedOptions options;
      options.lattice = fine_lattice;
      double light = 0;
      constexpr int seeds = 400;
      for (int i = 0; i < seeds; ++i) {
        FoundFacets found;
        SourceVisibility out;
        x.stream = hash_of(uint64_t(i), 9u);
        evaluate_alone(options, source, {&x, 1}, scene, found, {&out, 1});
        light += double(out.unoccluded) * double(out.visible) / seeds;
      }
      CAPTURE(is_hidden);
      CHECK(light == doctest::Approx(expected).epsilon(4e-3));
    }
  }
}

TEST_CASE("clusters: planes stay together, each receiver is in one") {
  Random r(2);
  std::vector<Vec3> positions, normals;
  for (int i = 0; i < 64; ++i) {
    const bool is_wall = i % 3 == 0;
    const float a = r.next_float(), b = r.next_float();
    positions.push_back(is_wall ? Vec3{1, a, b} : Vec3{a, b, 0});
    normals.push_back(is_wall ? Vec3{-1, 0, 0} : Vec3{0, 0, 1});
  }
  ReceiverClusters clusters;
  cluster_receivers(positions, normals, 1, clusters);
  REQUIRE(clusters.size() == 2);
  std::vector<int> seen(positions.size(), 0);
  for (size_t c = 0; c < clusters.size(); ++c)
    for (const uint32_t m : clusters.members(c)) {
      ++seen[m];
      CHECK(normals[m].x == normals[clusters.members(c)[0]].x);
    }
  for (const int s : seen) CHECK(s == 1);
}
