// Tests of residual rays: their number, which of them arrive, and their contribution; and of the
// driver that returns finished answers.
#include <doctest/doctest.h>

#include <cmath>

#include "one_source.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// Queues all samples of the source as open from receiver 0, with `light` for the pair.
void queue_open(OneSource& one, float light, uint32_t passes = 1) {
  const MaskFrame frame = one.frame();
  const SourceTask task = one.task();
  MaskMemory memory;
  one.queue.frames.push_back(frame);
  for (uint32_t pass = 0; pass < passes; ++pass) {
    mask_share_of({task, frame, one.unoccluded, 1, false, passes > 1}, 0, {}, pass, memory);
    one.queue.add(0, one.receivers[0].origin, memory.samples, light, one.unoccluded[0], pass,
                  passes);
  }
}

}  // namespace

TEST_CASE("residual rays: numbers keep the bound, in proportion to the possible error of a pair") {
  OneSource one(receivers_on_floor(1, 1));
  queue_open(one, 0.2f);
  queue_open(one, 0.1f);
  RayLimits limits;
  limits.pair_error = 1e3f;  // only the receiver's own bound
  RayPlan plan;
  for (const float allowed : {0.02f, 0.01f, 0.005f}) {
    plan_rays(one.queue, {&allowed, 1}, limits, plan);
    REQUIRE(plan.groups.size() == 2);
    double bound = 0;
    for (const RayGroup& g : plan.groups) bound += sqr(double(g.light)) / (4 * g.count);
    const double all = sqr(0.3 / (2 * double(allowed)));
    CAPTURE(allowed);
    if (all <= limits.most_rays) {
      CHECK(bound <= 1.0001 * sqr(double(allowed)));
      CHECK(plan.groups[0].count == uint32_t(std::ceil(all * 2 / 3 - 1e-3)));
      CHECK(plan.groups[1].count == uint32_t(std::ceil(all / 3 - 1e-3)));
    } else {
      CHECK(plan.segments.size() <= limits.most_rays + 2);
    }
    CHECK(plan.segments.size() == plan.groups[0].count + plan.groups[1].count);
  }
  // a weak pair's own share
  limits.pair_error = 0.02f;
  const float allowed = 1e3f;
  plan_rays(one.queue, {&allowed, 1}, limits, plan);
  const double share = 0.1 / double(one.unoccluded[0]);
  const double wanted = std::min(sqr(0.5 * share / 0.02), double(limits.most_pair_rays));
  CHECK(plan.groups[1].count == uint32_t(std::ceil(wanted - 1e-3)));
}

TEST_CASE("residual rays: occluders are recorded, facets in the source's plane hide nothing") {
  for (const bool is_over_budget : {false, true}) {
    OneSource one(receivers_on_floor(1, 1));
    if (is_over_budget) one.found.note_over_budget({}, 1);
    BruteForceScene scene;
    scene.facets = {parallelogram_facet({-4, -4, 2}, {8, 0, 0}, {0, 8, 0}),
                    parallelogram_facet({0, -4, 1}, {4, 0, 0}, {0, 8, 0})};
    queue_open(one, 1);
    const float allowed = 0.04f;
    RayPlan plan;
    plan_rays(one.queue, {&allowed, 1}, {}, plan);
    TracedRays traced;
    trace_rays(one.queue.sources, plan, scene, traced);
    size_t free = 0;
    for (size_t i = 0; i < plan.segments.size(); ++i) {
      CHECK((traced.is_free[i] != 0) == (plan.segments[i].to.x < 0));
      free += traced.is_free[i];
    }
    CHECK(free > 30);
    CHECK(traced.tallies[0].free == double(free));
    // facets are not recorded where lists are over budget
    CHECK(one.found.entries().size() == (is_over_budget ? 0 : 1));
    if (!is_over_budget) CHECK(one.found.entries()[0].id == 1);
  }
}

TEST_CASE("residual rays: sums of light, of values, and of masks that share a pair") {
  OneSource one(receivers_on_floor(1, 1));
  BruteForceScene scene;
  scene.facets = {parallelogram_facet({0, -4, 1}, {4, 0, 0}, {0, 8, 0})};
  queue_open(one, 0.2f);
  queue_open(one, 0.05f, 4);
  const std::vector<Vec3> points{{-0.4f, 0, 2}, {-0.2f, 0, 2}, {0.2f, 0, 2}, {0.4f, 0, 2}};
  const std::vector<Rgb> values{Rgb{1}, Rgb{3}, Rgb{100}, Rgb{100}};
  one.queue.add(0, one.receivers[0].origin, points, values, 0.5f);
  const float allowed = 0.005f;
  RayMemory memory;
  const auto answers = cast_residual_rays(one.queue, scene, {&allowed, 1}, {}, 64, memory);
  REQUIRE(answers.size() == 6);
  CHECK(double(answers[0].light) == doctest::Approx(0.1).epsilon(0.05));
  CHECK(answers[0].light_variance > 0);
  double light = 0;
  for (size_t i = 1; i < 5; ++i) light += double(answers[i].light);
  CHECK(light == doctest::Approx(0.1).epsilon(0.1));
  CHECK(answers[1].light_variance > 0);  // the first holds the variance of all
  for (size_t i = 2; i < 5; ++i) CHECK(answers[i].light_variance == 0);
  CHECK(answers[5].value.g == doctest::Approx(0.5 * 4 / 4));
  CHECK(answers[5].rays == 4);
  // adding rays to a finished answer
  SourceVisibility v;
  v.unoccluded = 0.4f;
  v.visible = 0.25f;
  add_rays(answers[0], v);
  CHECK(v.visible == doctest::Approx(0.25f + answers[0].light / 0.4f));
  CHECK(v.variance == doctest::Approx(answers[0].light_variance / 0.16f));
  CHECK(v.rays == answers[0].rays);
}

TEST_CASE("sums over source cells become an answer; a light too weak to square gives no NaN") {
  SourceVisibility a;
  CellSum sum;
  set_answer(sum, 0.3f, a);
  CHECK(a.answer == ShadowAnswer::below);
  sum.add(0.1f, 1, 0, ShadowAnswer::lit);
  set_answer(sum, 0.3f, a);
  CHECK(a.answer == ShadowAnswer::lit);
  CHECK(a.visible == 1);
  sum.add(0.3f, 0, 0, ShadowAnswer::dark);
  set_answer(sum, 0.3f, a);
  CHECK(a.answer == ShadowAnswer::masked);
  CHECK(a.visible == doctest::Approx(0.25));
  sum.add(0.1f, 0.5f, 0.01f, ShadowAnswer::mixed);
  set_answer(sum, 0.3f, a);
  CHECK(a.answer == ShadowAnswer::mixed);
  CHECK(a.variance == doctest::Approx(0.0001 / 0.25));
  CellSum weak;
  weak.add(1e-24f, 0.5f, 0.01f, ShadowAnswer::masked);
  set_answer(weak, 1e-24f, a);
  CHECK(a.visible == doctest::Approx(0.5));
  CHECK(std::isfinite(a.variance));
  add_rays({0, 0, 1, 5e-25f, 0, {}, 0}, a);
  CHECK(a.visible == doctest::Approx(1));
  CHECK(std::isfinite(a.variance));
}

TEST_CASE("the driver answers each request once, finished; sources do not disturb each other") {
  const std::vector<ShadowReceiver> receivers = receivers_on_floor(8, 0.05f);
  BruteForceScene scene;
  scene.facets = {parallelogram_facet({0.1f, -0.4f, 1.1f}, {0.7f, 0.1f, 0.05f}, {-0.1f, 0.6f, 0}),
                  parallelogram_facet({-0.5f, -0.5f, 0.6f}, {0.02f, 0, 0}, {0.1f, 0.9f, 0.3f}),
                  parallelogram_facet({-0.2f, 0.1f, 1.9f}, {0.2f, 0, 0.1f}, {0, 0.2f, 0.2f})};
  FlatSource beside = ceiling_source(), below = ceiling_source();
  beside.plane.origin.x = 1.5;
  below.plane.origin.z = -3;
  const SphereSource sphere{{-1, 0, 2}, 0.2};
  std::vector<FoundFacets> found(4);
  const FlatSource middle = ceiling_source();
  std::vector<LightRequest> requests{request_for(middle, found[0]), request_for(below, found[1]),
                                     request_for(sphere, found[2]), request_for(beside, found[3])};
  ShadowCluster cluster;
  cluster.set(receivers);
  CertifiedMemory memory;
  for (const bool is_complete : {true, false}) {
    CertifiedOptions options;
    if (!is_complete) {
      options.longest_list = 1;
      options.most_halvings = 0;
    }
    std::vector<std::vector<SourceVisibility>> answers(4);
    std::vector<uint32_t> order;
    scene.segments = 0;
    certified_light(cluster, requests, nullptr, scene, options, memory,
                    [&](uint32_t request, std::span<const SourceVisibility> a) {
                      order.push_back(request);
                      answers[request].assign(a.begin(), a.end());
                    });
    REQUIRE(order.size() == 4);
    uint64_t rays = 0;
    bool has_waited = false;
    for (const uint32_t r : order) {
      REQUIRE(answers[r].size() == receivers.size());
      uint64_t of_request = 0;
      for (const SourceVisibility& v : answers[r]) of_request += v.rays;
      has_waited = has_waited || of_request > 0;
      rays += of_request;
      if (of_request > 0) continue;
      std::vector<SourceVisibility> alone(receivers.size());
      FoundFacets nothing;
      if (requests[r].flat != nullptr)
        evaluate_alone(options, *requests[r].flat, receivers, scene, nothing, alone);
      else
        evaluate_alone(options, *requests[r].sphere, receivers, scene, nothing, alone);
      for (size_t i = 0; i < receivers.size(); ++i) {
        CHECK(answers[r][i].visible == alone[i].visible);
        CHECK(answers[r][i].variance == alone[i].variance);
        CHECK(answers[r][i].answer == alone[i].answer);
      }
    }
    CHECK(has_waited == !is_complete);
    CHECK((rays > 0) == (scene.segments > 0));
    for (const SourceVisibility& v : answers[1]) CHECK(v.answer == ShadowAnswer::below);
    found.assign(4, {});
    for (size_t i = 0; i < 4; ++i) requests[i].found = &found[i];
  }
}
