// Input of make_bsdf.cpp and lost_light.cpp: a material with its textures and tables at one hit,
// and helpers on it. Texture values are clamped to [0,1]. Not part of the public interface; other
// code calls make_bsdf() (bsdf.h).
#pragma once

#include <array>
#include <cmath>

#include "bsdf/bsdf.h"
#include "bsdf/material_inputs.h"

namespace troffer {

struct Inputs {
  const BsdfTables& tables;
  const std::vector<Texture>& textures;
  const Material& material;
  const PreparedMaterial& prepared;
  const TexturePlace& uv;
  bool is_front;

  float value(const FloatInput& in) const { return safe01(evaluate(textures, in, uv)); }
  Rgb base() const { return safe01(evaluate(textures, material.base_color, uv)); }
};

// True if transmitted light goes straight on.
inline bool is_sheet(const Inputs& in) {
  return in.material.is_thin || std::abs(in.prepared.ior - 1) < index_matched;
}

// Returns the albedo table of rough solid glass under a film, or null.
inline const FilmGlassTable* film_glass_of(const Bsdf& b, const Inputs& in) {
  const bool has_one = b.film.share > 0 && !b.is_thin && in.prepared.film_glass >= 0;
  return has_one ? &in.tables.film_glass(in.prepared.film_glass) : nullptr;
}

// Mean missing energy of a lobe below which compensation is left out, because rounding outweighs
// it.
constexpr float negligible = 1e-5f;

// Returns 2 ∫ f c dc by eight-point Gauss quadrature in the fourth root t of the cosine, in which
// the tables are smooth: 8 ∫ f t⁷ dt.
template <class F>
float hemisphere_mean(const F& f) {
  constexpr std::array<float, 4> node{0.1834346f, 0.5255324f, 0.7966665f, 0.9602899f},
      weight{0.3626838f, 0.3137066f, 0.2223810f, 0.1012285f};
  float sum = 0;
  for (size_t i = 0; i < node.size(); ++i)
    for (const float side : {-1.0f, 1.0f}) {
      const float t = 0.5f + 0.5f * side * node[i], t2 = t * t, c = t2 * t2;
      sum += weight[i] * 4 * f(c) * t2 * t2 * t2 * t;
    }
  return sum;
}

// Adds the lobe for light that conducting microfacets of mean reflectance f scatter more than once
// (lost_light.cpp). `weight` is their share of the surface. Call after sheen and clear coat are
// set.
void add_metal_compensation(Bsdf& b, const Inputs& in, Rgb f, float weight);
// Adds the same for glass. Call after its rows are set. `tint` multiplies the transmitted part.
void add_glass_compensation(Bsdf& b, const Inputs& in, Rgb tint);

}  // namespace troffer
