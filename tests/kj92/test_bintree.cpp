// Samples one source behind analytic occluders: stops, full sampling, errors, density, kernels.
#include "kj92/bintree.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "occluders.h"
#include "support/stopwatch.h"

using namespace troffer;

namespace {

struct Errors {
  double bias = 0, rms = 0, rays = 0, standard_error = 0;
};

// Compares estimates over seeds with the exact visible share.
template <class Query>
Errors errors_of(const BintreeOptions& o, const Query& query, double truth, int seeds) {
  Bintree tree(o);
  std::vector<ShadowRayResult> results;
  Errors e;
  for (int s = 0; s < seeds; ++s) {
    const BintreeEstimate& b = sample_source(tree, results, hash_of(77, s), query);
    const double d = double(b.mean) - truth;
    e.bias += d / seeds;
    e.rms += d * d / seeds;
    e.rays += double(b.rays) / seeds;
  }
  e.standard_error = std::sqrt(std::max(0.0, e.rms - e.bias * e.bias) / seeds);
  e.rms = std::sqrt(e.rms);
  return e;
}

bool is_checkerboard_dark(const Vec2& p) {
  return (int(p.x * 6) + int(p.y * 6)) % 2 == 0;
}
bool is_quarter_dark(const Vec2& p) {
  return p.x < 0.5f && p.y < 0.5f;
}

}  // namespace

TEST_CASE("bintree: all light and all shadow take the initial rays and are exact") {
  for (const int initial : {1, 2, 4, 8, 16}) {
    for (const bool is_dark : {false, true}) {
      BintreeOptions o;
      o.initial_rays = initial;
      Bintree tree(o);
      std::vector<ShadowRayResult> results;
      const auto query = query_of([&](const Vec2&) { return is_dark; });
      const BintreeEstimate first = sample_source(tree, results, 1, query);
      CHECK(first.rays == uint32_t(initial));
      CHECK(first.mean == (is_dark ? 0.0f : 1.0f));
      CHECK(first.stop == BintreeStop::variance);
      CHECK(resample_source(tree, results, 2, query).rays == uint32_t(initial));
    }
  }
}

TEST_CASE("bintree: initial rays are rounded up to a power of two, within the cap") {
  BintreeOptions o;
  o.most_rays = 20;
  Bintree tree(o);
  tree.start(1, 1, 5);
  CHECK(tree.pending().size() == 8);
  tree.start(1, 1, 9);
  CHECK(tree.pending().size() == 16);
  tree.start(1, 1, 1000);
  CHECK(tree.pending().size() == 16);
  tree.start(1);
  CHECK(tree.pending().size() == 8);
  o.most_rays = 1;
  Bintree small(o);
  small.start(1);
  CHECK(small.pending().size() == 1);
}

TEST_CASE("bintree: allowed variance 0 with a cap is full stratified sampling") {
  const ConvexOccluder edge = half_plane({0.4, 0.5}, 1.2);
  for (int level = 3; level <= 9; ++level) {
    BintreeOptions o;
    o.allowed_variance = 0;
    o.most_rays = 1 << level;
    Bintree tree(o);
    std::vector<ShadowRayResult> results;
    const auto check = [&](const BintreeEstimate& e) {
      CHECK(e.stop == BintreeStop::cap);
      CHECK(e.rays == uint32_t(o.most_rays));
      std::vector<int> samples(size_t(o.most_rays), 0);
      const int columns = 1 << ((level + 1) / 2), rows = 1 << (level / 2);
      tree.nodes().for_each_leaf([&](int32_t i) {
        const BintreeNode& n = tree.nodes()[i];
        CHECK(n.level == level);
        const int column = int(n.uv.x * float(columns)), row = int(n.uv.y * float(rows));
        ++samples[size_t(row * columns + column)];
      });
      for (const int s : samples) CHECK(s == 1);
    };
    check(sample_source(tree, results, 3, query_of(edge)));
    check(resample_source(tree, results, 4, query_of(edge)));
    check(sample_source(tree, results, 5, query_of([](const Vec2&) { return false; })));
  }
}

TEST_CASE("bintree: full stratified sampling is unbiased, adaptive sampling within a bound") {
  const ConvexOccluder edge = half_plane({0.43, 0.5}, 1.2), disk = disk_occluder({0.5, 0.4}, 0.3);
  const ConvexOccluder leg = turned_rectangle({0.55, 0.5}, 0.07, 1.6, 0.2);
  const auto check = [](const char* name, const auto& query, double truth) {
    BintreeOptions o;
    o.allowed_variance = 0;
    o.most_rays = 64;
    const Errors full = errors_of(o, query, truth, 2000);
    // 6 checks with 4 standard errors keep the rate of false alarms under 4e-4
    CHECK(std::abs(full.bias) < 4 * full.standard_error + 2e-5);
    o.allowed_variance = 0.05f;
    o.most_rays = 128;
    const Errors e = errors_of(o, query, truth, 2000);
    MESSAGE(std::string(name) << ": visible " << truth << "; adaptive, allowed 0.05: bias "
                              << e.bias << ", rms error " << e.rms << ", rays " << e.rays
                              << "; stratified 64: rms error " << full.rms);
    // Light is overestimated where thin shadows fall between the initial rays: most trees miss the
    // table leg. The checkerboard is too fine for the rules.
    CHECK(std::abs(e.bias) < 0.055);
    CHECK(e.rms < 0.09);
    CHECK(e.rays < 128);
  };
  check("edge", query_of(edge), 1 - edge.area());
  check("disk", query_of(disk), 1 - disk.area());
  check("table leg", query_of(leg), 1 - leg.area());
  check("quarter", query_of(is_quarter_dark), 0.75);
  check("checkerboard", query_of(is_checkerboard_dark), 0.5);
  check("half", query_of([](const Vec2& p) { return p.x >= 0.5f; }), 0.5);
}

TEST_CASE("bintree: a refinement sequence, round by round") {
  BintreeOptions o;
  o.initial_rays = 4;
  o.level_difference = 1;
  o.allowed_variance = 0.01f;
  o.mean_change = 0;
  Bintree tree(o);
  std::vector<ShadowRayResult> results;
  // true if the leaf with this cell exists
  const auto has_leaf = [&](float u0, float u1, float v0, float v1) {
    bool is_found = false;
    tree.nodes().for_each_leaf([&](int32_t i) {
      const SourceCell c = tree.nodes().cell(i);
      is_found |= c.u0 == u0 && c.u1 == u1 && c.v0 == v0 && c.v1 == v1;
    });
    return is_found;
  };
  const auto answer = [&] {
    results.resize(tree.pending().size());
    query_of(is_quarter_dark)(tree.pending(), results);
    tree.supply(results);
  };
  for (uint64_t stream = 0; stream < 20; ++stream) {
    tree.start(stream);
    CHECK(tree.pending().size() == 4);
    answer();
    // The left half is mixed. In it, the dark quarter differs from its right neighbour.
    CHECK(tree.pending().size() == 1);
    CHECK(has_leaf(0, 0.25f, 0, 0.5f));
    CHECK(has_leaf(0.25f, 0.5f, 0, 0.5f));
    answer();
    // The dark quarter again. Both halves differ from a neighbour and have one ray, so the first is
    // split, to level 4. The quarter above it, of level 2, must then be split too.
    CHECK(tree.pending().size() == 2);
    CHECK(has_leaf(0, 0.25f, 0.25f, 0.5f));
    CHECK(has_leaf(0, 0.25f, 0.5f, 1));
    CHECK(tree.leaves() == 7);
    answer();
    // The second half has fewer rays and is split, and with it the quarter to its right.
    CHECK(tree.pending().size() == 2);
    CHECK(has_leaf(0.25f, 0.5f, 0.25f, 0.5f));
    CHECK(has_leaf(0.5f, 0.75f, 0, 0.5f));
    CHECK(has_leaf(0.5f, 1, 0.5f, 1));  // touches leaves of level 4 only at a corner
    CHECK(tree.leaves() == 9);
  }
}

TEST_CASE("bintree: no ray is lost or cast twice while a tree grows") {
  const ConvexOccluder edge = half_plane({0.43, 0.5}, 1.2);
  BintreeOptions o;
  o.allowed_variance = 0.03f;
  Bintree tree(o);
  std::vector<ShadowRayResult> results;
  std::vector<Vec2> cast;
  const auto order = [](const Vec2& a, const Vec2& b) {
    return a.x != b.x ? a.x < b.x : a.y < b.y;
  };
  tree.start(11);
  while (!tree.pending().empty()) {
    cast.insert(cast.end(), tree.pending().begin(), tree.pending().end());
    results.resize(tree.pending().size());
    query_of(edge)(tree.pending(), results);
    tree.supply(results);
    std::vector<Vec2> asked = cast, held;
    asked.insert(asked.end(), tree.pending().begin(), tree.pending().end());
    tree.nodes().for_each_leaf([&](int32_t i) { held.push_back(tree.nodes()[i].uv); });
    std::sort(asked.begin(), asked.end(), order);
    std::sort(held.begin(), held.end(), order);
    CHECK(asked == held);
  }
}

TEST_CASE("bintree: its error estimate when it stops, and the cap") {
  Random random(4);
  for (int k = 0; k < 300; ++k) {
    BintreeOptions o;
    o.allowed_variance = 0.02f + 0.1f * random.next_float();
    o.most_rays = 8 + int(random.next_u32() % 120);
    o.level_difference = 1 + k % 3;
    Bintree tree(o);
    std::vector<ShadowRayResult> results;
    const ConvexOccluder edge =
        half_plane({random.next_double(), random.next_double()}, 6 * random.next_double());
    size_t asked = 0, rounds = 0;
    tree.start(hash_of(k));
    while (!tree.pending().empty()) {
      results.resize(tree.pending().size());
      query_of(edge)(tree.pending(), results);
      asked += results.size();
      CHECK(tree.estimate().stop == BintreeStop::none);
      tree.supply(results);
      if (rounds++ == 0) CHECK(asked == 8);
    }
    const BintreeEstimate& e = tree.estimate();
    CHECK(asked == e.rays);
    CHECK(e.rays == tree.leaves());
    CHECK(e.rays == tree.nodes()[BintreeNodes::root].samples);
    CHECK(e.rays <= uint32_t(o.most_rays));
    CHECK(e.stop != BintreeStop::none);
    const bool is_met = std::sqrt(e.variance) < o.allowed_variance;
    CHECK(is_met == (e.stop == BintreeStop::variance));
    if (e.stop == BintreeStop::cap) CHECK(e.rays == uint32_t(o.most_rays));
    if (e.rays < uint32_t(o.most_rays)) {  // the cap also ends the enforcement
      CHECK(largest_level_difference(tree.nodes()) <= o.level_difference);
    }
  }
}

TEST_CASE("rule 5: the second stopping rule waits for enough rays and then saves some") {
  BintreeOptions o;
  o.allowed_variance = 0.02f;
  o.most_rays = 1024;
  const ConvexOccluder edge = half_plane({0.43, 0.5}, 1.2);
  std::vector<ShadowRayResult> results;
  double rays[2] = {};
  for (const bool is_on : {false, true}) {
    o.mean_change = is_on ? 0.01f : 0;
    o.enough_rays = 48;
    Bintree tree(o);
    for (int s = 0; s < 100; ++s) {
      const BintreeEstimate& e = sample_source(tree, results, hash_of(5, s), query_of(edge));
      rays[is_on] += e.rays;
      CHECK((e.stop == BintreeStop::mean || e.stop == BintreeStop::variance));
      if (!is_on) CHECK(e.stop == BintreeStop::variance);
      if (e.stop == BintreeStop::mean) CHECK(e.rays >= 48);
    }
  }
  CHECK(rays[1] < 0.5 * rays[0]);
}

TEST_CASE("bintree: rays concentrate at the shadow edge") {
  BintreeOptions o;
  o.allowed_variance = 0.03f;
  o.most_rays = 512;
  Bintree tree(o);
  std::vector<ShadowRayResult> results;
  const double slope = 1.2;
  const ConvexOccluder edge = half_plane({0.5, 0.5}, slope);
  double near = 0, all = 0, near_area = 0;
  Random random(6);
  const auto is_near = [&](const Vec2& p) {
    const Vec2d d = Vec2d(p) - Vec2d{0.5, 0.5};
    return std::abs(-std::sin(slope) * d.x + std::cos(slope) * d.y) < 0.05;
  };
  for (int k = 0; k < 100000; ++k) near_area += is_near(random.next_vec2()) ? 1e-5 : 0;
  for (int s = 0; s < 50; ++s) {
    sample_source(tree, results, hash_of(8, s), query_of(edge));
    tree.nodes().for_each_leaf([&](int32_t i) {
      near += is_near(tree.nodes()[i].uv) ? 1 : 0;
      all += 1;
    });
  }
  const double density = near / near_area, elsewhere = (all - near) / (1 - near_area);
  MESSAGE("density of rays within 0.05 of an edge over density elsewhere: " << density / elsewhere);
  CHECK(density > 3 * elsewhere);
}

TEST_CASE("bintree: kernels weigh visibility; the allowance is relative to the unoccluded value") {
  // kernel 2u (mean 1), right half hidden: 1/4
  const auto query = [](float scale) {
    return [scale](std::span<const Vec2> uv, std::span<ShadowRayResult> results) {
      for (size_t i = 0; i < uv.size(); ++i) results[i] = {uv[i].x < 0.5f, 2 * scale * uv[i].x};
    };
  };
  BintreeOptions o;
  o.allowed_variance = 0.03f;
  o.mean_change = 0;
  o.most_rays = 1024;
  Bintree a(o), b(o);
  std::vector<ShadowRayResult> results;
  double mean = 0, kernel = 0;
  for (int s = 0; s < 200; ++s) {
    const BintreeEstimate ea = sample_source(a, results, hash_of(9, s), query(1), 1);
    const BintreeEstimate eb = sample_source(b, results, hash_of(9, s), query(64), 64);
    CHECK(ea.rays == eb.rays);  // powers of two: the same decisions, exactly
    CHECK(ea.mean * 64 == eb.mean);
    mean += double(ea.mean) / 200;
    kernel += double(a.kernel_mean()) / 200;
  }
  CHECK(mean == doctest::Approx(0.25).epsilon(0.02));
  CHECK(kernel == doctest::Approx(1).epsilon(0.01));
  // all visible: a varying kernel needs more rays, a constant one does not
  const auto near = [](std::span<const Vec2> uv, std::span<ShadowRayResult> out) {
    for (size_t i = 0; i < uv.size(); ++i) out[i] = {true, 2 * uv[i].x};
  };
  const uint32_t rays = sample_source(a, results, 1, near).rays;
  CHECK(double(rays) == doctest::Approx(1 / 3.0 / sqr(0.03)).epsilon(0.05));  // Var 2u = 1/3
  CHECK(double(a.estimate().mean) == doctest::Approx(1).epsilon(0.01));
}

TEST_CASE(
    "bintree: results depend on the stream alone; no memory is allocated after the first point") {
  const ConvexOccluder edge = half_plane({0.43, 0.5}, 1.2);
  BintreeOptions o;
  o.allowed_variance = 0.03f;
  Bintree fresh(o), used(o);
  std::vector<ShadowRayResult> results;
  const size_t capacity = used.nodes().capacity();
  for (int s = 0; s < 50; ++s) resample_source(used, results, hash_of(1, s), query_of(edge));
  for (int s = 0; s < 50; ++s) {
    const BintreeEstimate a = sample_source(fresh, results, hash_of(2, s), query_of(edge));
    const BintreeEstimate b = sample_source(used, results, hash_of(2, s), query_of(edge));
    CHECK(a.mean == b.mean);
    CHECK(a.rays == b.rays);
    // the pattern must be the same, too, wherever its nodes are stored
    const BintreeEstimate c = resample_source(fresh, results, hash_of(3, s), query_of(edge));
    const BintreeEstimate d = resample_source(used, results, hash_of(3, s), query_of(edge));
    CHECK(c.mean == d.mean);
    CHECK(c.rays == d.rays);
    if (s % 2 == 0) {  // gives `used` another history
      resample_source(used, results, hash_of(4, s), query_of(edge));
    }
  }
  CHECK(used.nodes().capacity() == capacity);
}

TEST_CASE("bintree: overhead per ray besides tracing") {
  BintreeOptions o;
  o.allowed_variance = 0.05f;
  Bintree tree(o);
  std::vector<ShadowRayResult> results;
  for (const bool is_coherent : {false, true}) {
    size_t rays = 0;
    const test::ProcessorStopwatch watch;
    for (int i = 0; i < 10000; ++i) {
      const float edge = float(i % 100) / 100;
      const auto query = query_of([edge](const Vec2& p) { return p.x + 0.3f * p.y < edge; });
      const uint64_t stream = hash_of(10, i);
      rays += is_coherent && i % 100 != 0 ? resample_source(tree, results, stream, query).rays
                                          : sample_source(tree, results, stream, query).rays;
    }
    const double ns = 1e9 * watch.seconds();
    MESSAGE(std::string(is_coherent ? "with" : "without")
            << " coherence: " << ns / double(rays) << " ns a ray");
    CHECK(rays > 0);
  }
}
