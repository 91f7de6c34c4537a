// Attenuation of light in one direction by the coat, sheen and clear coat of a Bsdf. The separable
// lobes multiply the factors g of both directions. Evaluation (bsdf.cpp), sampling (choice.h) and
// construction (make_bsdf.cpp) use it. All factors are shares in [0,1].
#pragma once

#include "bsdf/bsdf.h"
#include "bsdf/fresnel.h"

namespace troffer {

// Factors g of the separable lobes for a direction on the viewer's side.
struct Gains {
  float diffuse = 1, soft = 0, glass = 0;
  // Shares that the sheen and the clear coat pass. The three factors above already contain them.
  float pass = 1, coat = 1;
  float sheen = 0;       // albedo of a white sheen
  float coat_gloss = 1;  // share of gloss that the clear coat passes
};

inline float missing(const AlbedoRow& row, const CosineCoordinate& at) {
  return row.values == nullptr ? 0.0f : std::max(0.0f, 1 - row.at(at));
}

inline Gains gains_at(const Bsdf& b, const Vec3& w) {
  Gains g;
  const float cosine = w.z;
  const SoftDirection direction(w);
  const CosineCoordinate& at = direction.cosine;
  switch (b.coat) {
    case Bsdf::Coat::none:
      break;
    case Bsdf::Coat::smooth_dielectric:
      g.diffuse = 1 - fresnel_dielectric(cosine, b.eta);
      break;
    case Bsdf::Coat::smooth_schlick:
      g.diffuse = 1 - (b.coat_f0 + (b.coat_f90 - b.coat_f0) * pow5(1 - cosine));
      break;
    case Bsdf::Coat::dielectric:
      g.diffuse = missing(b.coat_row, at);
      break;
    case Bsdf::Coat::schlick: {
      const float one = b.one.at(at), grazing = b.grazing.at(at);
      g.diffuse = std::max(0.0f, 1 - (b.coat_f0 * (one - grazing) + b.coat_f90 * grazing));
      break;
    }
  }
  g.soft = soft_gain(b.soft, direction);
  if (b.glass_weight > 0) g.glass = missing(b.near, at);
  if (b.cover.share > 0 && !b.is_within) {
    g.pass = b.cover.pass(at);
    g.diffuse *= g.pass;
    g.soft *= g.pass;
    g.glass *= g.pass;
    if (b.cover.is_shown) g.sheen = b.cover.white.at(at);
  }
  if (b.clear.share > 0 && !b.is_within) {
    const float coat = b.clear.pass(cosine);
    g.diffuse *= coat;
    g.glass *= coat;
    const float own = b.clear.has_normal ? dot(w, b.clear.normal) : cosine;
    g.coat = b.clear.has_normal ? b.clear.pass(own) : coat;
    g.coat_gloss = b.clear.gloss_pass(own);
    g.soft *= g.coat;
  }
  return g;
}

// True if the covers of glass lie on its far side (for a sheet: also there).
inline bool has_cover_on_far_side(const Bsdf& b) {
  return b.is_thin || b.is_within;
}

// Returns g of glass for a direction on the far side of the given cosine.
inline float far_glass_gain(const Bsdf& b, float cosine) {
  const CosineCoordinate at(cosine);
  const float lost = missing(b.far, at);
  return has_cover_on_far_side(b) ? lost * b.cover.pass(at) * b.clear.pass(cosine) : lost;
}

// Returns the factor by which sheen reduces gloss: the smaller of the shares that the sheen passes
// in both directions. Directions on a side without sheen count as 1.
inline float sheen_pass(const Bsdf& b, float cos_o, float cos_i) {
  const auto pass = [&b](float c) { return b.cover.pass(CosineCoordinate(std::abs(c))); };
  const float near = b.is_within ? 1.0f : pass(cos_o);
  if (cos_i > 0) return b.is_within ? 1.0f : std::min(near, pass(cos_i));
  return has_cover_on_far_side(b) ? std::min(near, pass(cos_i)) : near;
}

// Returns gains_at(), or defaults without computing them if the Bsdf does not need them.
inline Gains gains_of(const Bsdf& b, const Vec3& w) {
  return b.has_separable || b.clear.share > 0 || b.cover.share > 0 ? gains_at(b, w) : Gains{};
}

}  // namespace troffer
