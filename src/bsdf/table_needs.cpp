// Tables that a material needs, and whether it is a pane.
#include <algorithm>

#include "bsdf/material_inputs.h"

namespace troffer {

namespace {

bool can_be_rough(const Material& m) {
  return m.roughness.texture >= 0 || m.roughness.value >= 1e-6f || m.anisotropy.value > 0;
}

bool can_coat_be_rough(const Material& m) {
  return m.coat_roughness.texture >= 0 || m.coat_roughness.value >= 1e-6f;
}

}  // namespace

bool is_pane(const Material& m) {
  if (m.is_mirror_pane) return true;
  const bool is_glass =
      m.kind == MaterialKind::dielectric || (m.kind == MaterialKind::metallic_roughness &&
                                             m.transmission.value > 0 && m.metallic.value < 1);
  if (!is_glass || !m.is_thin || m.is_alpha_masked) return false;
  return m.roughness.texture < 0 &&
         alpha_of(safe01(m.roughness.value), m.roughness_meaning) < smooth_alpha;
}

TableNeeds table_needs(const Material& m, float clear_ior) {
  const bool is_rough = can_be_rough(m);
  TableNeeds n;
  const bool has_coat_of_width = has_clear_coat(m) && can_coat_be_rough(m);
  n.has_ggx = (is_rough || has_coat_of_width) && m.kind != MaterialKind::diffuse;
  bool is_glass = false;
  switch (m.kind) {
    case MaterialKind::diffuse:
    case MaterialKind::angular:
      break;
    case MaterialKind::coated_diffuse:
      n.has_coat = is_rough;
      if (m.facets != FacetModel::balanced && m.roughness.texture < 0) {
        const float alpha = alpha_of(safe01(m.roughness.value), m.roughness_meaning);
        if (alpha >= smooth_alpha) n.single_coat_alpha = alpha;
      }
      n.has_dielectric_average = true;
      break;
    case MaterialKind::conductor:
      n.has_conductor_average = true;
      break;
    case MaterialKind::dielectric:
      is_glass = true;
      break;
    case MaterialKind::metallic_roughness:
      is_glass = m.transmission.value > 0;
      break;
  }
  n.has_glass = is_glass && is_rough && !m.is_thin;
  n.has_sheen = has_sheen(m);
  n.has_film = m.kind == MaterialKind::metallic_roughness && m.iridescence.value > 0;
  const bool is_film_even =
      m.iridescence.texture < 0 && m.film_thickness.texture < 0 && m.roughness.texture < 0;
  if (n.has_film && n.has_glass && is_film_even) {
    const float alpha = alpha_of(safe01(m.roughness.value), m.roughness_meaning);
    if (alpha >= smooth_alpha) n.filmed_alpha = alpha;
  }
  const bool is_metal = m.kind == MaterialKind::conductor ||
                        (m.kind == MaterialKind::metallic_roughness && m.metallic.value > 0);
  const bool is_even = m.anisotropy.texture < 0 && m.roughness.texture < 0;
  ClearCoat clear;
  if (has_clear_coat(m)) {
    clear = clear_coat_of(m, safe01(m.coat.value), safe01(m.coat_roughness.value), clear_ior);
    n.has_clear_coat = has_coat_of_width;
    n.has_clear_inside = has_coat_of_width && clear.bend > 1;
  }
  const bool is_coat_even = m.coat.texture < 0 && m.coat_roughness.texture < 0;
  if (is_metal && is_even && is_coat_even) {
    const GgxWidths a =
        widths_of(base_alpha(m, safe01(m.roughness.value), clear), safe01(m.anisotropy.value));
    const bool is_lossy = clear.share > 0 && a.across > smooth_alpha;
    if (a.along > a.across || is_lossy) n.grain = a;
    n.coat_over_grain = clear;
  } else if (is_metal && is_even && m.anisotropy.value > 0 && !(clear.bend > 1)) {
    n.grain = widths_of(alpha_of(safe01(m.roughness.value), m.roughness_meaning),
                        safe01(m.anisotropy.value));
  }
  n.has_dielectric_average |= is_glass;
  return n;
}

}  // namespace troffer
