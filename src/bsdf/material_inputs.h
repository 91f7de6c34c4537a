// Material parameters in the form that make_bsdf.cpp, tables.cpp and table_needs.cpp use: clamped
// to valid ranges, with roughness converted to a GGX width. NaN becomes 0. Lengths of films are in
// nanometres.
#pragma once

#include <algorithm>
#include <cmath>

#include "bsdf/bsdf.h"
#include "bsdf/fresnel.h"

namespace troffer {

inline float safe01(float x) {
  return x > 0 ? std::min(x, 1.0f) : 0.0f;
}  // NaN reads as 0
inline Rgb safe01(Rgb c) {
  return {safe01(c.r), safe01(c.g), safe01(c.b)};
}
inline Rgb safe_depth(Rgb v) {
  const auto safe = [](float x) { return x > 0 ? std::min(x, 1e6f) : 0.0f; };
  return {safe(v.r), safe(v.g), safe(v.b)};
}

inline float alpha_of(float roughness, RoughnessMeaning meaning) {
  switch (meaning) {
    case RoughnessMeaning::alpha:
      return roughness;
    case RoughnessMeaning::alpha_is_sqrt:
      return std::sqrt(roughness);
    case RoughnessMeaning::alpha_is_square:
      return roughness * roughness;
  }
  return roughness;
}

inline bool has_sheen(const Material& m) {
  return m.kind == MaterialKind::metallic_roughness && !m.sheen_color.value.is_black();
}

inline GgxWidths widths_of(float alpha, float strength) {
  return {alpha + (1 - alpha) * sqr(strength), std::max(alpha, smooth_alpha)};
}

inline bool has_clear_coat(const Material& m) {
  return m.coat.value > 0 && m.kind != MaterialKind::diffuse;
}

// Returns the film with the given share and thickness parameter in [0,1], without the reflectances
// below it.
inline ThinFilm film_of(const Material& m, float share, float thickness,
                        const InterferenceTable& table) {
  ThinFilm film;
  film.share = share;
  film.ior = std::clamp(m.film_ior, 1.0f, 10.0f);
  film.thickness_nm = std::max(lerp(m.film_thinnest_nm, m.film_thickest_nm, thickness), 0.0f);
  film.table = &table;
  return film;
}

// Returns the clear coat with the given share and roughness, without table and normal. Over a
// conductor it is a layer on the whole surface.
inline ClearCoat clear_coat_of(const Material& m, float share, float roughness, float ior) {
  ClearCoat c;
  c.share = m.kind == MaterialKind::conductor ? 1 : share;
  c.eta = ior;
  c.alpha = alpha_of(roughness, m.roughness_meaning);
  c.is_smooth = c.alpha < smooth_alpha;
  if (m.kind == MaterialKind::conductor) c.bend = std::max(ior, 1.0f);
  return c;
}

// Returns the GGX width of the gloss below the clear coat.
inline float base_alpha(const Material& m, float roughness, const ClearCoat& clear) {
  const float alpha = alpha_of(roughness, m.roughness_meaning);
  return clear.share > 0 && clear.bend > 1 && !clear.is_smooth
             ? widened_below(alpha, clear.alpha, clear.bend)
             : alpha;
}

}  // namespace troffer
