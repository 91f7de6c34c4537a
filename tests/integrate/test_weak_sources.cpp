// Bounds on what a source can send, and the drawing of weak sources.
#include <doctest/doctest.h>

#include <cmath>

#include "base/random.h"
#include "integrate/weak_sources.h"

using namespace troffer;

namespace {

Vec3 random_point(Random& r, float size) {
  return Vec3{r.next_float() - 0.5f, r.next_float() - 0.5f, r.next_float() - 0.5f} * size;
}

CertifiedSource random_source(Random& r) {
  CertifiedSource s;
  s.radiance = Rgb{0.2f + r.next_float()};
  const Vec3d centre(random_point(r, 8));
  if (r.next_float() < 0.2f) {
    s.is_round = true;
    s.sphere = {centre, 0.02 + 0.5 * r.next_double()};
    return s;
  }
  const Vec3d u(random_point(r, 1.0f)), v0(random_point(r, 1.0f));
  const Vec3d n = normalize(cross(u, v0));
  s.flat.plane = {centre, u, v0, r.next_float() < 0.5f ? n : -n};
  s.flat.is_disk = false;
  return s;
}

}  // namespace

TEST_CASE("no receiver in the ball gets more than the bound") {
  int seen = 0, tight = 0;
  for (uint64_t seed = 0; seed < 4000; ++seed) {
    Random r(seed);
    const CertifiedSource source = random_source(r);
    ClusterBall ball;
    ball.centre = random_point(r, 6);
    ball.radius = seed % 3 == 0 ? 0.001f : 0.5f * r.next_float();
    const Vec3 n = normalize(random_point(r, 1));
    const bool is_flat = seed % 2 == 0;
    if (is_flat) ball.normal = n;
    // steps: one normal, several planes
    ball.depth = is_flat && seed % 4 == 0 ? ball.radius * r.next_float() : 0;
    float estimate = 0;
    const float bound = unoccluded_bound(source, ball, estimate);
    for (int i = 0; i < 20; ++i) {
      Vec3 d = random_point(r, 1);
      if (is_flat) d = d - n * dot(d, n);
      Vec3 x = ball.centre + normalize(d) * (ball.radius * std::sqrt(r.next_float()));
      if (ball.depth > 0) x = ball.centre - n * (ball.depth * r.next_float());
      const Vec3 normal = is_flat ? n : normalize(random_point(r, 1));
      const double value = source.unoccluded(Vec3d(x), Vec3d(normal));
      CHECK(value <= double(bound) * (1 + 1e-4) + 1e-9);
      if (value > 0) ++seen;
      if (value > 0.5 * double(bound)) ++tight;
    }
  }
  CHECK(seen > 10000);
  CHECK(tight > 1000);
}

TEST_CASE("drawn sources stand for the weak ones: unbiased, within the error that is allowed") {
  std::vector<CertifiedSource> sources;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j) {
      CertifiedSource s;
      s.radiance = Rgb{1 + float((7 * i + 3 * j) % 5)};
      s.flat.plane = {{2.0 * i, 2.0 * j, 3}, {0, 0.3, 0}, {0.3, 0, 0}, {0, 0, -1}};
      sources.push_back(s);
    }
  ClusterBall ball;
  ball.centre = {3.3f, 4.1f, 0};
  ball.radius = 0.05f;
  ball.normal = {0, 0, 1};
  // an arbitrary visible share for each source
  const auto visible = [](uint32_t i) { return unit_float(uint32_t(mix64(i + 77))); };
  const auto light = [&](uint32_t i) {
    return double(sources[i].radiance.g) * sources[i].unoccluded(Vec3d(ball.centre), {0, 0, 1});
  };
  double all = 0, expected = 0;
  for (uint32_t i = 0; i < sources.size(); ++i) {
    all += light(i);
    expected += light(i) * double(visible(i));
  }
  for (const float error : {0.003f, 0.01f, 0.05f}) {
    double sum = 0, sum2 = 0;
    size_t treated = 0;
    constexpr int draws = 4000;
    for (uint64_t k = 0; k < draws; ++k) {
      WeakSourcesScratch scratch;
      choose_sources(sources, ball, error, mix64(k + 5), scratch);
      double estimate = 0;
      for (const uint32_t i : scratch.weak) estimate += light(i);
      for (const ChosenSource& c : scratch.chosen)
        estimate += c.is_drawn()
                        ? double(c.weight) * light(c.source) * double(visible(c.source) - 1)
                        : light(c.source) * double(visible(c.source));
      sum += estimate;
      sum2 += estimate * estimate;
      treated = scratch.chosen.size();
    }
    const double mean = sum / draws,
                 deviation = std::sqrt(std::max(sum2 / draws - mean * mean, 0.0));
    CAPTURE(error);
    CHECK(treated < sources.size() / 2);
    CHECK(std::abs(mean - expected) < 4 * deviation / std::sqrt(double(draws)));
    CHECK(deviation > 0);
    CHECK(deviation < double(error) * all);
    MESSAGE("allowed ", error, ": ", treated, " of ", sources.size(), " treated, deviation ",
            deviation / all);
  }
  WeakSourcesScratch scratch;
  choose_sources(sources, ball, 0, 1, scratch);
  CHECK(scratch.chosen.size() == sources.size());
  for (const ChosenSource& c : scratch.chosen) CHECK(!c.is_drawn());
  CHECK(scratch.weak.empty());
}
