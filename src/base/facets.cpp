#include "base/facets.h"

#include <algorithm>

#include "base/units.h"

namespace troffer {

namespace {

double facet_g1(FacetShape shape, double alpha, double cosine) {
  return double(smith_g1(shape, float(alpha * alpha * (1 - cosine * cosine) / (cosine * cosine))));
}

struct FacetInterface {
  double reflectance, refracted_cosine;
};
FacetInterface at_facet(double c, double index) {
  const double sine2 = (1 - c * c) / (index * index);
  if (sine2 >= 1) return {1, 0};
  const double t = std::sqrt(1 - sine2);
  const double parallel = (index * c - t) / (index * c + t);
  const double perpendicular = (c - index * t) / (c + index * t);
  return {(parallel * parallel + perpendicular * perpendicular) / 2, t};
}

}  // namespace

// Midpoint rule over the microfacets, weighted by their projected area. Symmetry halves the
// azimuths. Steep microfacets, which have large weights, get more nodes.
RoughShares rough_shares(FacetShape shape, double alpha, double index, double cosine) {
  constexpr int n = 48;
  const double c = std::clamp(cosine, 1e-6, 1.0), s = std::sqrt(1 - c * c);
  const double seen = facet_g1(shape, alpha, c);
  RoughShares sum;
  for (int j = 0; j < n; ++j) {
    const double rest = 1 - (j + 0.5) / n,
                 steeper = rest * rest;  // share of the steeper microfacets
    const double tangent =
        alpha * std::sqrt(shape == FacetShape::ggx ? (1 - steeper) / steeper : -std::log(steeper));
    const double z = 1 / std::sqrt(1 + tangent * tangent);
    for (int i = 0; i < n; ++i) {
      const double d = s * tangent * z * std::cos(pi * (i + 0.5) / n) + c * z;
      if (d <= 0) continue;
      const FacetInterface at = at_facet(std::min(d, 1.0), index);
      const double weight = 2 * rest / (n * n) * seen * d / (c * z);
      const double up = 2 * d * z - c, down = z * (d / index - at.refracted_cosine) - c / index;
      if (up > 0)
        sum.reflected += weight * at.reflectance * facet_g1(shape, alpha, std::min(up, 1.0));
      if (down < 0)
        sum.through += weight * (1 - at.reflectance) * facet_g1(shape, alpha, std::min(-down, 1.0));
    }
  }
  return sum;
}

float mean_rough_reflectance_inside(FacetShape shape, double alpha, double index) {
  constexpr int n = 64;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double c = double(i) / (n - 1);
    sum += 2 * c / n * rough_shares(shape, alpha, 1 / index, c).reflected;
  }
  return float(std::min(sum, 1.0));
}

}  // namespace troffer
