// Energy that each lobe of a Bsdf scatters from one direction, and the probability with which
// sample() chooses each lobe. bsdf.cpp samples and computes albedo() with it. Energies are shares
// of the incident energy; estimates suffice for probabilities.
#pragma once

#include <cmath>

#include "bsdf/bsdf.h"
#include "bsdf/coated_glass.h"
#include "bsdf/gains.h"
#include "bsdf/split.h"

namespace troffer {

// Returns the share of energy from a direction of cosine c that leaves through the glossy lobe.
inline Rgb glossy_albedo(const Bsdf& b, float c) {
  if (b.fresnel == Bsdf::Fresnel::none) return Rgb{0};
  if (b.is_smooth) {
    const Split s = facet_split(b, c);
    return s.reflected + s.transmitted;
  }
  const CosineCoordinate at(c);
  if (b.fresnel == Bsdf::Fresnel::coat) return b.coat_gloss.at(at) * b.reflected_share;
  // Approximation: the film's colour at the mirror direction stands for all facets.
  if (b.film.share > 0 && b.fresnel == Bsdf::Fresnel::schlick)
    return split_at(b, c).reflected * b.one.at(at);
  const float grazing = b.grazing.at(at), steep = b.one.at(at) - grazing;
  // Approximation: a conductor counts as a Schlick lobe of the same reflectance at normal
  // incidence.
  if (b.fresnel == Bsdf::Fresnel::conductor)
    return (fresnel_conductor(1, b.f0, b.f90) * steep + Rgb{grazing}) * b.reflected_share;
  const Rgb opaque = b.f0 * steep + b.f90 * grazing;
  if (b.fresnel == Bsdf::Fresnel::schlick) return opaque;
  // Glass loses energy as a whole. Approximation: the rest divides as for a mirror.
  const Split s = split_at(b, c);
  return opaque + (s.reflected - fresnel_schlick(c, b.f0, b.f90) + s.transmitted) * b.near.at(at);
}

// Returns the same below a clear coat.
inline Rgb glossy_albedo_below(const Bsdf& b, float pass, float c) {
  if (!(b.clear.share > 0) || b.fresnel == Bsdf::Fresnel::none) return glossy_albedo(b, c) * pass;
  // For smooth glass, glossy_albedo already includes the coat.
  if (b.has_transmission) return b.is_smooth ? glossy_albedo(b, c) : glossy_albedo(b, c) * pass;
  const float inside = b.clear.cosine_below(c);
  const Rgb all = glossy_albedo(b, inside);
  // Share of light that leaves the coat again, where the albedo table under the coat exists.
  const bool is_known = b.soft.kind != SoftLobe::Kind::none && !b.is_smooth;
  const float out = is_known ? b.soft.glossy.at(CosineCoordinate(c)) /
                                   std::max(b.one.at(CosineCoordinate(inside)), 1e-3f)
                             : 1.0f;
  return all * b.clear.kept(pass, all) * std::min(out, 1.0f);
}

// Energies of the lobes: clear coat, glossy, diffuse, and lost energy returned on either side.
struct Energies {
  float clear = 0;
  Rgb glossy, diffuse, again, through;
};
inline Energies energies_at(const Bsdf& b, const Gains& g, float cos_o) {
  Energies e;
  if (b.clear.has_lobe()) e.clear = 1 - g.coat;
  e.glossy = glossy_albedo_below(b, g.coat, cos_o) * g.pass;
  if (!b.has_separable) return e;
  e.diffuse = b.diffuse * (g.diffuse * b.diffuse_mean);
  e.again = soft_energy(b.soft, g.soft) + b.cover.colour * g.sheen * g.coat +
            b.glass_lost_reflected * (g.glass * b.near_mean);
  e.through = b.glass_lost_transmitted * (g.glass * b.far_mean);
  return e;
}

// Probabilities of the sampling techniques, proportional to the energies: clear coat, glossy lobe,
// and directions of cosine or uniform density on either side. Returned lost energy is more uniform
// than a cosine: on smoother surfaces it lies closer to grazing.
struct Choice {
  float clear = 0, glossy = 0, cosine = 0, uniform = 0, cosine_through = 0, uniform_through = 0;
};
inline Choice choice_at(const Bsdf& b, const Gains& g, float cos_o) {
  if (!b.clear.has_lobe()) {
    if (b.fresnel == Bsdf::Fresnel::none) return {0, 0, 1, 0, 0, 0};
    if (!b.has_separable) return {0, 1, 0, 0, 0, 0};
  }
  const Energies e = energies_at(b, g, cos_o);
  const float glossy = average(e.glossy), diffuse = average(e.diffuse);
  const float again = average(e.again), through = average(e.through);
  const float sum = e.clear + glossy + diffuse + again + through;
  if (!(sum > 0)) return {};
  const float s = 1 / sum, uniform = 1 - b.alpha;
  return {e.clear * s,
          glossy * s,
          (diffuse + again * b.alpha) * s,
          again * uniform * s,
          through * b.alpha * s,
          through * uniform * s};
}

// Returns the density of all techniques except the clear coat and the glossy lobe.
inline float separable_pdf(const Choice& c, float cos_i) {
  constexpr float uniform = 0.5f * inv_pi_f;
  return cos_i > 0 ? c.cosine * cos_i * inv_pi_f + c.uniform * uniform
                   : c.cosine_through * -cos_i * inv_pi_f + c.uniform_through * uniform;
}

}  // namespace troffer
