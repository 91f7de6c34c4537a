#include "render/rare_light.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "render/sample_sets.h"

namespace troffer {

namespace {

constexpr double normal_kurtosis = 3;
// Assumed squared relative difference between the variances of a list's points.
constexpr double variety = 0.25;

double variance_of_sample(const PointLight& p) {
  return sqr(p.indirect.standard_error) * p.samples;
}

// Means over the points of a list.
struct Usual {
  double variance = 0;           // variance of one sample, lx²
  double relative_variance = 0;  // variance of one sample over the square of the point's light
  double kurtosis = normal_kurtosis;
};

Usual usual_of(const std::vector<PointLight>& points) {
  Usual u;
  double variance = 0, relative = 0, kurtosis = 0;
  int lit = 0;
  for (const PointLight& p : points) {
    if (!(p.all.illuminance_lx > 0)) continue;
    ++lit;
    variance += variance_of_sample(p);
    relative += variance_of_sample(p) / sqr(p.all.illuminance_lx);
    kurtosis += p.kurtosis;
  }
  if (lit > 0) u = {variance / lit, relative / lit, kurtosis / lit};
  return u;
}

}  // namespace

// The variance estimated from n sets has a squared relative error of (kurtosis - 1) / n; the part
// that normal sets have is left out. The list's variance differs from the point's by `variety`. The
// result is the mean of both, weighted by the inverse of these (empirical Bayes).
void raise_errors_for_rare_light(std::vector<PointLight>& points,
                                 const std::vector<size_t>& which) {
  const Usual usual = usual_of(points);
  const double off = std::max(usual.kurtosis - normal_kurtosis, 0.0) / most_sets;
  const double weight = off / (off + variety);
  for (const size_t i : which) {
    PointLight& p = points[i];
    if (p.samples <= 0) continue;  // not measured because of a stop
    const double own = variance_of_sample(p);
    const double of_list =
        std::min(usual.variance, usual.relative_variance * sqr(p.all.illuminance_lx));
    const double more = weight * std::max(of_list - own, 0.0) / p.samples;
    for (double* e : {&p.all.standard_error, &p.indirect.standard_error, &p.other_part_error})
      *e = std::sqrt(sqr(*e) + more);
  }
}

}  // namespace troffer
