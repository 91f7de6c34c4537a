// Tests the classification of sources: thresholds, and properties that always hold.
#include "kj92/source_class.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "base/random.h"

using namespace troffer;

namespace {

using Points = std::vector<SourceAtPoint>;

SourceClass class_of(const Points& points, float mean = -1, SelectionThresholds t = {}) {
  if (mean < 0) {
    mean = 0;
    for (const SourceAtPoint& p : points) mean += p.total / float(points.size());
  }
  return classify(points, mean, t);
}

// Returns points that receive `rest` from other sources and `unoccluded` × visibility from this
// one.
Points seen(float unoccluded, const std::vector<float>& visibilities, float rest = 1) {
  Points points;
  for (const float r : visibilities)
    points.push_back({r * unoccluded, unoccluded, rest + r * unoccluded});
  return points;
}

Points random_points(Random& random, float gain = 1) {
  const size_t n = 1 + random.next_u32() % 12;
  const float kind = random.next_float();
  const float strength = std::pow(10.0f, 4 * random.next_float() - 3);
  Points points;
  for (size_t i = 0; i < n; ++i) {
    const float unoccluded = gain * strength * random.next_float();
    const float r = kind < 0.2f ? 0 : kind < 0.4f ? 1 : random.next_float();
    points.push_back({r * unoccluded, unoccluded, random.next_float() + r * unoccluded});
  }
  return points;
}

bool is_general(const SourceClass& c) {
  return c.treatment == SourceTreatment::general;
}

}  // namespace

TEST_CASE("hidden at all points: a strong source is probed, a weak one is ignored") {
  const SourceClass strong = class_of(seen(5, {0, 0, 0.003f}));
  CHECK(strong.view == SourceView::occluded);
  CHECK(strong.treatment == SourceTreatment::probed);
  // If a source is very strong, a visibility of 2 % makes a visible edge.
  const SourceClass blinding = class_of(seen(50, {0, 0.02f}));
  CHECK(blinding.view == SourceView::occluded);
  CHECK(blinding.treatment == SourceTreatment::sampled);
  const SourceClass weak = class_of(seen(0.01f, {0, 0, 0}));
  CHECK(weak.view == SourceView::occluded);
  CHECK(is_general(weak));
}

TEST_CASE("visible at all points: never sampled") {
  const SourceClass strong = class_of(seen(5, {1, 1, 0.995f}));
  CHECK(strong.view == SourceView::visible);
  CHECK(strong.treatment == SourceTreatment::probed);
  const SourceClass weak = class_of(seen(0.01f, {1, 1, 1}));
  CHECK(weak.view == SourceView::visible);
  CHECK(is_general(weak));
}

TEST_CASE("a weak source with a visible shadow edge is sampled, one without is not") {
  const SourceClass edge = class_of(seen(0.04f, {0, 1}));
  CHECK(edge.view == SourceView::partly);
  CHECK(edge.share < SelectionThresholds{}.major_share);
  CHECK(edge.treatment == SourceTreatment::sampled);
  CHECK(is_general(class_of(seen(0.04f, {0.4f, 0.5f}))));                        // no spread
  CHECK(is_general(class_of(seen(0.015f, {0, 1}))));                             // too weak
  CHECK(class_of(seen(2, {0.5f, 0.5f})).treatment == SourceTreatment::sampled);  // strong
}

TEST_CASE("thresholds include their exact values") {
  SelectionThresholds t;
  t.occluded_below = 0.25f;
  t.visible_above = 0.75f;
  t.major_share = 0.5f;
  t.shadow_edge = 0.25f;
  t.probe_share = 0.125f;
  t.least_share = 0.0625f;
  const auto at = [&](const Points& p) { return classify(p, 1, t); };
  CHECK(at({{0.25f, 1, 1}}).view == SourceView::occluded);
  CHECK(at({{0.2500001f, 1, 1}}).view == SourceView::partly);
  CHECK(at({{0.75f, 1, 1}}).view == SourceView::visible);
  CHECK(at({{0.7499999f, 1, 1}}).view == SourceView::partly);
  CHECK(at({{0.5f, 1, 1}}).treatment == SourceTreatment::sampled);
  CHECK(is_general(at({{0.499f, 1, 1}})));
  // spread 0.5 × unoccluded 0.5 = shadow_edge
  CHECK(at({{0, 0.5f, 1}, {0.25f, 0.5f, 1}}).treatment == SourceTreatment::sampled);
  CHECK(is_general(at({{0.0f, 0.4999f, 1}, {0.24995f, 0.4999f, 1}})));
  CHECK(at({{0, 0.125f, 1}}).treatment == SourceTreatment::probed);
  CHECK(is_general(at({{0, 0.12499f, 1}})));
  CHECK(at({{0.125f, 0.125f, 1}}).treatment == SourceTreatment::probed);
  CHECK(is_general(at({{0.12499f, 0.12499f, 1}})));
  // a point counts only above least_share
  CHECK(at({{0, 0.0625f, 1}, {1, 1, 1}}).view == SourceView::visible);
  CHECK(at({{0, 0.0626f, 1}, {1, 1, 1}}).view == SourceView::partly);
}

TEST_CASE("points that do not count, and patches with no points that count") {
  for (const Points& points : {Points{}, Points{{0, 0, 0}}, Points{{0, 0, 1}},
                               Points{{0, 1e-6f, 1}}, Points{{0, 0, 1}, {0, 1e-6f, 1}}}) {
    const SourceClass c = class_of(points, 1);
    CHECK(c.view == SourceView::occluded);
    CHECK(is_general(c));
    CHECK(c.share == 0);
    CHECK(c.least_visibility == 0);
    CHECK(c.most_visibility == 0);
  }
  // A horizon that crosses the patch is not a shadow, so points below it do not count.
  CHECK(class_of({{0, 0, 1}, {2, 2, 3}, {2, 2, 3}}).view == SourceView::visible);
}

TEST_CASE("dark points are compared with the patch's mean, dark patches with themselves") {
  // A dark corner of a bright patch receives little in total.
  CHECK(is_general(class_of({{0.004f, 0.008f, 0.004f}, {0.004f, 0.008f, 1}, {0, 0, 2}}, 1)));
  // The same light on a patch that is dark everywhere is important.
  CHECK(class_of({{0.004f, 0.008f, 0.004f}, {0.004f, 0.008f, 0.005f}}).treatment ==
        SourceTreatment::sampled);
}

TEST_CASE("invariants for arbitrary points") {
  Random random(1);
  int sampled = 0, probed = 0, general = 0;
  for (int i = 0; i < 20000; ++i) {
    const Points points = random_points(random);
    const SourceClass c = class_of(points);
    CHECK(c.least_visibility <= c.most_visibility);
    CHECK(c.least_visibility >= 0);
    CHECK(c.most_visibility <= 1);
    CHECK(c.share >= 0);
    CHECK(c.share <= 1.00001f);
    if (c.view == SourceView::visible) CHECK(c.treatment != SourceTreatment::sampled);
    if (c.view == SourceView::partly) CHECK(c.treatment != SourceTreatment::probed);
    if (c.most_visibility == 0) CHECK(c.treatment != SourceTreatment::sampled);
    sampled += c.treatment == SourceTreatment::sampled;
    probed += c.treatment == SourceTreatment::probed;
    general += c.treatment == SourceTreatment::general;
    // Neither the order nor the unit of light matters.
    Points other = points;
    std::reverse(other.begin(), other.end());
    for (SourceAtPoint& p : other) p = {4 * p.received, 4 * p.unoccluded, 4 * p.total};
    const SourceClass d = class_of(other);
    CHECK(d.view == c.view);
    CHECK(d.least_visibility == c.least_visibility);
  }
  CHECK(sampled > 1000);
  CHECK(probed > 1000);
  CHECK(general > 1000);
}

TEST_CASE("a partly hidden source that grows never falls out of sampling") {
  Random random(2);
  int rises = 0;
  for (int i = 0; i < 4000; ++i) {
    const size_t n = 1 + random.next_u32() % 8;
    Points shape;
    std::vector<float> rest;
    for (size_t k = 0; k < n; ++k) {
      const float u = random.next_float();
      shape.push_back({u * random.next_float(), u, 0});
      rest.push_back(random.next_float());
    }
    bool was_sampled = false;
    for (float gain = 1e-4f; gain < 1e3f; gain *= 1.7f) {
      Points points = shape;
      float mean = 0;
      for (size_t k = 0; k < n; ++k) {
        SourceAtPoint& p = points[k];
        p = {gain * p.received, gain * p.unoccluded, rest[k] + gain * p.received};
        mean += p.total / float(n);
      }
      const SourceClass c = classify(points, mean, {});
      if (c.view != SourceView::partly) continue;
      const bool is_sampled = c.treatment == SourceTreatment::sampled;
      CHECK((is_sampled || !was_sampled));
      rises += is_sampled && !was_sampled;
      was_sampled = is_sampled;
    }
  }
  CHECK(rises > 3000);
}

TEST_CASE("on a dark patch a hidden source is probed, however weak it is") {
  const std::vector<SourceAtPoint> dark{{0, 3, 0}, {0, 2, 0}};
  const SourceClass c = classify(dark, 0, {});
  CHECK(c.view == SourceView::occluded);
  CHECK(c.treatment == SourceTreatment::probed);
}
