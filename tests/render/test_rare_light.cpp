// Standard errors where few of many samples find light.
#include "render/rare_light.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numeric>

#include "base/random.h"
#include "render/sample_sets.h"

using namespace troffer;

namespace {

int poisson(Random& random, double mean) {
  int n = -1;
  for (double left = std::exp(-mean), product = 1; product > left || n < 0; ++n)
    product *= random.next_double();
  return n;
}

double normal(Random& random) {
  double sum = -6;
  for (int i = 0; i < 12; ++i) sum += random.next_double();
  return sum;
}

// Returns a point of `lx`, by 32 sets that err by `noise` each. A part `rare` of its light comes
// from `met` samples on average over all sets.
PointLight point(Random& random, double lx, double noise, double rare, double met) {
  SampleSets sets;
  for (int s = 0; s < most_sets; ++s) {
    const double came = met > 0 ? poisson(random, met / most_sets) * most_sets / met : 0;
    sets.add({}, lx * (1 - rare + rare * came + noise * normal(random)));
  }
  PointLight p;
  p.all = p.indirect = {Rgb{}, sets.luminance(), sets.standard_error()};
  p.other_part_error = sets.standard_error();
  p.kurtosis = sets.kurtosis();
  p.samples = 4096;
  return p;
}

std::vector<size_t> all_of(const std::vector<PointLight>& points) {
  std::vector<size_t> which(points.size());
  std::iota(which.begin(), which.end(), size_t{0});
  return which;
}

double share_that_holds(const std::vector<PointLight>& points, double lx) {
  int inside = 0;
  for (const PointLight& p : points)
    inside += std::abs(p.all.illuminance_lx - lx) <= 1.96 * p.all.standard_error;
  return double(inside) / double(points.size());
}

}  // namespace

TEST_CASE("kurtosis: 3 for normal sets, the number of sets if one differs from all others") {
  SampleSets same;
  for (int s = 0; s < most_sets; ++s) same.add({}, 7);
  CHECK(same.kurtosis() == 3);
  SampleSets one;
  for (int s = 0; s < most_sets; ++s) one.add({}, s == 11 ? 9 : 7);
  const double n = most_sets;
  CHECK(one.kurtosis() == doctest::Approx(n - 2 + 1 / (n - 1)).epsilon(1e-9));
  Random random(3);
  double sum = 0;
  constexpr int lists = 4000;
  for (int k = 0; k < lists; ++k) {
    SampleSets sets;
    for (int s = 0; s < most_sets; ++s) sets.add({}, 1e3 + normal(random));
    sum += sets.kurtosis() / lists;
  }
  // Kurtosis of n normal samples: 3 (n - 1) / (n + 1). Sums of twelve uniform numbers are 0.1 below
  // normal.
  CHECK(sum == doctest::Approx(2.9 * (n - 1) / (n + 1)).epsilon(0.02));
}

TEST_CASE("points that missed rare light get the error that others of the list have found") {
  Random random(1);
  std::vector<PointLight> points;
  for (int i = 0; i < 300; ++i) points.push_back(point(random, 100, 0.001, 0.02, 1.5));
  CHECK(share_that_holds(points, 100) < 0.8);
  // One of them, with the information of all.
  std::vector<PointLight> few = points;
  size_t quiet = 0;
  while (few[quiet].all.standard_error > 0.1) ++quiet;
  raise_errors_for_rare_light(few, {quiet});
  CHECK(few[quiet].all.standard_error > 0.5);
  CHECK(few[quiet + 1].all.standard_error == points[quiet + 1].all.standard_error);
  raise_errors_for_rare_light(points, all_of(points));
  CHECK(share_that_holds(points, 100) > 0.95);
  for (const PointLight& p : points) {
    CHECK(p.indirect.standard_error == doctest::Approx(p.all.standard_error));
    CHECK(p.other_part_error == doctest::Approx(p.all.standard_error));
  }
}

TEST_CASE("points with normally distributed sets keep their errors, and so does a single point") {
  Random random(2);
  std::vector<PointLight> points;
  for (int i = 0; i < 300; ++i) points.push_back(point(random, 100, i % 2 == 0 ? 0.01 : 0.1, 0, 0));
  const std::vector<PointLight> before = points;
  raise_errors_for_rare_light(points, all_of(points));
  for (size_t i = 0; i < points.size(); ++i)
    CHECK(points[i].all.standard_error <= before[i].all.standard_error * 1.1);
  std::vector<PointLight> one{point(random, 100, 0.001, 0.02, 1)};
  const double own = one[0].all.standard_error;
  raise_errors_for_rare_light(one, all_of(one));
  CHECK(one[0].all.standard_error == doctest::Approx(own));
}

TEST_CASE("neither dark points, with large relative errors, nor bright ones affect the others") {
  Random random(4);
  std::vector<PointLight> points;
  for (int i = 0; i < 100; ++i) points.push_back(point(random, 1e-3, 0.01, 0.9, 1));
  for (int i = 0; i < 100; ++i) points.push_back(point(random, 100, 0.01, 0, 0));
  const std::vector<PointLight> before = points;
  raise_errors_for_rare_light(points, all_of(points));
  for (size_t i = 0; i < 100; ++i) CHECK(points[i].all.standard_error < 3e-3);
  for (size_t i = 100; i < 200; ++i)
    CHECK(points[i].all.standard_error < 1.2 * before[i].all.standard_error);
}
