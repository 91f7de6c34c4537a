// Distribution of a Bsdf's microfacets with shadowing and masking, by its FacetModel.
//
// Facets that scatter once are also sampled by GGX's visible normals. For equal width GGX has more
// steep facets than Beckmann, so that no weight exceeds 4/e times that of exact sampling.
//
// References: [1] Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR
//   2007 (Eq. 25 and 33).
#pragma once

#include <cmath>

#include "base/facets.h"
#include "bsdf/bsdf.h"
#include "bsdf/ggx.h"
#include "bsdf/ggx_grained.h"

namespace troffer {

inline FacetShape shape_of(FacetModel m) {
  return m == FacetModel::single_beckmann ? FacetShape::beckmann : FacetShape::ggx;
}

inline float beckmann_distribution(const Vec3& m, const GgxWidths& a) {
  if (!(m.z > 0)) return 0;
  const float z2 = m.z * m.z;
  const float tan2 = (sqr(m.x / a.along) + sqr(m.y / a.across)) / z2;
  return std::exp(-tan2) / (pi_f * a.along * a.across * z2 * z2);
}

// Returns G1(o) G1(i) / (4 cos cos), for directions above the surface.
inline float separate_visibility(FacetShape shape, const Vec3& o, const Vec3& i,
                                 const GgxWidths& a) {
  const auto g1 = [&](const Vec3& w) {
    return smith_g1(shape, (sqr(a.along * w.x) + sqr(a.across * w.y)) / (w.z * w.z));
  };
  return g1(o) * g1(i) / std::max(4 * o.z * i.z, 1e-30f);
}

// Returns D(m) G(o, i) / (4 cos cos), for directions above the surface.
inline float facet_density(const Bsdf& b, const Vec3& m, const Vec3& o, const Vec3& i) {
  if (b.facets == FacetModel::balanced)
    return b.is_grained ? ggx_distribution(m, b.widths) * ggx_visibility(o, i, b.widths)
                        : ggx_distribution(m, b.alpha) * ggx_visibility(o.z, i.z, b.alpha);
  const GgxWidths a = b.is_grained ? b.widths : GgxWidths{b.alpha, b.alpha};
  const float d = b.facets == FacetModel::single_beckmann ? beckmann_distribution(m, a)
                                                          : ggx_distribution(m, a);
  return d * separate_visibility(shape_of(b.facets), o, i, a);
}

}  // namespace troffer
