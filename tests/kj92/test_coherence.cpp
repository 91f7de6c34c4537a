// Tests pattern reuse from point to point (docs/method/bintree.md) under moving shadows.
#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "kj92/bintree.h"
#include "occluders.h"

using namespace troffer;

namespace {

enum class Moving { edge, leg, disk };

ConvexOccluder occluder_at(Moving kind, double x, double y) {
  switch (kind) {
    case Moving::edge:
      return half_plane({x, 0.5}, 1.2);
    case Moving::leg:
      return turned_rectangle({x, y}, 0.07, 1.4, 0.2);
    case Moving::disk:
      break;
  }
  return disk_occluder({x, y}, 0.3);
}

struct Result {
  double rms = 0, rays = 0, bias = 0;
};

// Scans lines of points while the occluder crosses the source. Each line starts without a pattern.
Result scan(const BintreeOptions& o, bool is_coherent, Moving kind) {
  constexpr int lines = 24, points = 96;
  Bintree tree(o);
  std::vector<ShadowRayResult> results;
  Result r;
  for (int line = 0; line < lines; ++line) {
    for (int i = 0; i < points; ++i) {
      const ConvexOccluder occluder =
          occluder_at(kind, (i + 0.5) / points * 1.6 - 0.3, 0.2 + 0.02 * line);
      const uint64_t stream = hash_of(uint64_t(line), i, int(kind));
      const BintreeEstimate& e = is_coherent && i > 0
                                     ? resample_source(tree, results, stream, query_of(occluder))
                                     : sample_source(tree, results, stream, query_of(occluder));
      const double d = double(e.mean) - (1 - occluder.area());
      r.rms += d * d / (lines * points);
      r.bias += d / (lines * points);
      r.rays += double(e.rays) / (lines * points);
    }
  }
  r.rms = std::sqrt(r.rms);
  return r;
}

}  // namespace

TEST_CASE("coherence: the same point again takes no more rays than the pattern has leaves") {
  Random random(1);
  for (int k = 0; k < 300; ++k) {
    BintreeOptions o;
    o.allowed_variance = 0.04f;
    o.mean_change = 0;
    o.most_rays = 1024;
    o.renews_jitter = false;
    Bintree tree(o);
    std::vector<ShadowRayResult> results;
    const ConvexOccluder edge =
        half_plane({random.next_double(), random.next_double()}, 6 * random.next_double());
    const uint32_t first = sample_source(tree, results, hash_of(2, k), query_of(edge)).rays;
    tree.resample(hash_of(3, k));
    CHECK(tree.pending().size() == first);
    const BintreeEstimate again = answer_all(tree, results, query_of(edge));
    CHECK(again.rays == first);
    CHECK(again.stop == BintreeStop::variance);
    // With shrinking the number is about the same. The variance falls with the number of rays, so
    // removed rays are replaced by others at the edge.
    const uint32_t shrunk = resample_source(tree, results, hash_of(4, k), query_of(edge)).rays;
    CHECK(double(shrunk) <= 1.15 * first + 4);
  }
}

TEST_CASE("coherence: a pattern resampled without refinement is unbiased") {
  // The cells come from another point, so the new rays are independent of them.
  BintreeOptions o;
  o.allowed_variance = 0.05f;
  const ConvexOccluder before = half_plane({0.43, 0.5}, 1.2), now = half_plane({0.5, 0.5}, 1.2);
  const double truth = 1 - now.area();
  Bintree tree(o);
  std::vector<ShadowRayResult> results;
  double sum = 0, squares = 0;
  constexpr int n = 4000;
  for (int s = 0; s < n; ++s) {
    sample_source(tree, results, hash_of(5, s), query_of(before));
    tree.shrink();
    // The allowed error is so large that the first round ends the sampling.
    tree.resample(hash_of(6, s), 1e6f);
    const BintreeEstimate& e = answer_all(tree, results, query_of(now));
    CHECK(e.rays == tree.leaves());
    const double d = double(e.mean) - truth;
    sum += d / n;
    squares += d * d / n;
  }
  CHECK(std::abs(sum) < 4 * std::sqrt(squares / n));
}

TEST_CASE("coherence: moving shadows, error and rays with and without") {
  for (const Moving kind : {Moving::edge, Moving::leg, Moving::disk}) {
    for (const float allowed : {0.07f, 0.05f, 0.03f}) {
      BintreeOptions o;
      o.allowed_variance = allowed;
      o.mean_change = 0;
      o.most_rays = 256;
      const Result without = scan(o, false, kind), with = scan(o, true, kind);
      o.renews_jitter = false;
      const Result kept = scan(o, true, kind);
      const char* name = kind == Moving::edge ? "edge" : kind == Moving::leg ? "leg" : "disk";
      MESSAGE(std::string(name) << ", allowed " << double(allowed) << ": rays " << without.rays
                                << " -> " << with.rays << ", rms error " << without.rms << " -> "
                                << with.rms << " (" << without.rms / with.rms << " times), bias "
                                << without.bias << " -> " << with.bias
                                << "; old positions kept: rms error " << kept.rms << ", rays "
                                << kept.rays);
      CHECK(with.rms < without.rms / 1.25);
      // without coherence a thin leg is often missed, which costs no rays
      if (kind != Moving::leg) CHECK(with.rays < 1.2 * without.rays);
    }
  }
}

TEST_CASE("coherence: invariants along random walks") {
  Random random(7);
  for (int k = 0; k < 40; ++k) {
    BintreeOptions o;
    o.initial_rays = 4 << (k % 3);
    o.allowed_variance = 0.03f;
    o.level_difference = 1 + k % 2;
    o.most_rays = 64;
    o.renews_jitter = k % 5 != 0;
    Bintree tree(o);
    std::vector<ShadowRayResult> results;
    Vec2d p{random.next_double(), random.next_double()};
    tree.start(hash_of(8, k));
    for (int step = 0; step < 60; ++step) {
      p = p + Vec2d{random.next_double() - 0.5, random.next_double() - 0.5} * 0.1;
      const ConvexOccluder disk = disk_occluder(p, 0.3);
      const uint32_t resampled = uint32_t(tree.pending().size());
      const BintreeEstimate e = answer_all(tree, results, query_of(disk));
      CHECK(e.rays >= resampled);
      CHECK(e.rays <= 64);
      const size_t leaves = tree.leaves();
      tree.shrink();
      CHECK(tree.leaves() <= leaves);
      CHECK(tree.leaves() >= size_t(o.initial_rays));
      size_t counted = 0;
      float area = 0;
      tree.nodes().for_each_leaf([&](int32_t i) {
        CHECK(tree.nodes()[i].level >= tree.initial_level());
        area += tree.nodes().cell(i).measure();
        ++counted;
      });
      CHECK(counted == tree.leaves());
      CHECK(area == 1.0f);
      CHECK(tree.estimate().mean == e.mean);
      tree.resample(hash_of(9, k, step));
    }
  }
}
