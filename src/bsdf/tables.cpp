#include "bsdf/tables.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "bsdf/facet_lobe.h"
#include "bsdf/fresnel.h"
#include "bsdf/index_classes.h"
#include "bsdf/material_inputs.h"

namespace troffer {

namespace {

float safe_ior(float ior) {
  return std::isfinite(ior) && ior > 0 ? std::clamp(ior, 0.01f, 100.0f) : 1.5f;
}

// Indices of refraction of the tables of a scene.
struct Indices {
  IndexClasses coats, glasses;
};

// Adds the indices for which a material needs tables.
void add_indices(const PreparedMaterial& p, const TableNeeds& needs, Indices& indices) {
  if (needs.has_coat) indices.coats.add(p.ior);
  if (needs.has_clear_coat) indices.coats.add(p.clear_coat_ior);
  if (needs.has_clear_inside) indices.coats.add(1 / p.clear_coat_ior);
  if (needs.has_glass && std::abs(p.ior - 1) >= index_matched) indices.glasses.add(p.ior);
}

template <class Table>
void set_indices(const IndexClasses& classes, std::vector<Table>& tables) {
  tables.resize(classes.size());
  for (size_t i = 0; i < tables.size(); ++i) tables[i].ior = classes.representative(i);
}

// How much two parameters of tables that are not negative differ: their ratio's logarithm, or the
// difference where they are small.
float distance(float a, float b) {
  constexpr float small = 1e-3f;
  return std::abs(std::log((a + small) / (b + small)));
}

float distance(const ClearCoat& a, const ClearCoat& b) {
  return distance(a.share, b.share) + distance(a.alpha, b.alpha) + distance(a.eta, b.eta) +
         distance(a.bend, b.bend);
}

// Returns the table of least distance; makes one if none has distance 0 and there is room.
template <class Table, class Distance, class Make>
int32_t nearest_or_new(std::vector<Table>& tables, size_t most, const Distance& distance,
                       const Make& make) {
  size_t nearest = 0;
  float least = std::numeric_limits<float>::infinity();
  for (size_t i = 0; i < tables.size(); ++i) {
    const float d = distance(tables[i]);
    if (!(d < least)) continue;
    least = d;
    nearest = i;
  }
  if (least == 0 || tables.size() >= most) return int32_t(nearest);
  tables.push_back(make());
  return int32_t(tables.size() - 1);
}

// True if alpha lets a share of the light straight through. Shadow rays then pass it like a pane.
bool is_blended(const Material& m) {
  return m.is_alpha_masked && m.is_alpha_blended && (m.alpha.texture >= 0 || m.alpha.value < 1);
}

}  // namespace

BsdfTables::BsdfTables(const std::vector<Material>& materials) {
  bool needs_ggx = false, needs_sheen = false, needs_film = false;
  Indices indices;
  std::vector<TableNeeds> all_needs;
  for (const Material& m : materials) {
    PreparedMaterial p;
    p.ior = safe_ior(m.ior);
    p.clear_coat_ior = safe_ior(m.coat_ior);
    p.is_pane = is_pane(m) || is_blended(m);
    const TableNeeds needs = table_needs(m, p.clear_coat_ior);
    needs_ggx |= needs.has_ggx;
    needs_sheen |= needs.has_sheen;
    needs_film |= needs.has_film;
    add_indices(p, needs, indices);
    if (needs.single_coat_alpha > 0)
      p.rough_coat = rough_coat_for(m, needs.single_coat_alpha, p.ior);
    if (needs.has_dielectric_average) {
      p.dielectric_average = fresnel_dielectric_average(p.ior);
      p.plate_average = plate_reflectance_average(p.ior);
    }
    if (needs.has_conductor_average) {
      const Rgb eta = safe_index(m.eta), k = safe_index(m.k);
      for (size_t c = 0; c < 3; ++c)
        p.conductor_average[c] = fresnel_conductor_average(eta[c], k[c]);
    }
    all_needs.push_back(needs);
    materials_.push_back(p);
  }
  // Clear coats have two indices, one from each side.
  indices.coats.divide(2 * max_indices);
  indices.glasses.divide(max_indices);
  set_indices(indices.coats, coats_);
  set_indices(indices.glasses, glasses_);
  for (size_t i = 0; i < materials.size(); ++i) {
    PreparedMaterial& p = materials_[i];
    const TableNeeds& needs = all_needs[i];
    if (needs.has_coat) p.coat = indices.coats.of(p.ior);
    if (needs.has_clear_coat) p.clear_coat = indices.coats.of(p.clear_coat_ior);
    if (needs.has_clear_inside) p.clear_inside = indices.coats.of(1 / p.clear_coat_ior);
    if (needs.has_glass && std::abs(p.ior - 1) >= index_matched)
      p.glass = indices.glasses.of(p.ior);
  }
  if (needs_ggx) build_albedo_tables(ggx_, coats_, glasses_);
  if (needs_sheen) build_sheen_table(sheen_);
  if (needs_film) interference_ = make_interference_table();
  build_angular_lobes(materials);
  build_grain_tables(materials);
  build_film_glass_tables(materials);
  for (size_t i = 0; i < reflectances; ++i)
    reflectance_average_[i] =
        fresnel_conductor_average(1, k_from_reflectance(float(i) / float(reflectances - 1)));
}

void BsdfTables::set_rows(ClearCoat& clear, const PreparedMaterial& p) const {
  if (!(clear.share > 0) || clear.is_smooth) return;
  clear.row = coat(p.clear_coat).reflected.row(clear.alpha);
  if (clear.bend > 1) clear.inner = coat(p.clear_inside).reflected.row(clear.alpha);
}

int32_t BsdfTables::rough_coat_for(const Material& m, float alpha, float ior) {
  const FacetShape shape = shape_of(m.facets);
  constexpr float other_shape = 1e3f;  // more than any difference of width and index
  return nearest_or_new(
      rough_coats_, max_parameters,
      [&](const RoughCoatTable& t) {
        return distance(t.alpha, alpha) + distance(t.ior, ior) +
               (t.shape == shape ? 0.0f : other_shape);
      },
      [&] { return make_rough_coat_table(shape, alpha, ior); });
}

// Materials with the same matrices and treatment of peaks share a lobe.
void BsdfTables::build_angular_lobes(const std::vector<Material>& materials) {
  std::map<std::pair<const AngularBsdf*, bool>, int32_t> known;
  for (size_t k = 0; k < materials.size(); ++k) {
    const Material& m = materials[k];
    if (m.kind != MaterialKind::angular) continue;
    const auto [at, is_new] =
        known.insert({{m.angular.get(), m.has_sharp_peak}, int32_t(angulars_.size())});
    if (is_new) angulars_.emplace_back(*m.angular, m.has_sharp_peak);
    materials_[k].angular = at->second;
    materials_[k].is_pane = angulars_[size_t(at->second)].has_straight();
  }
}

// Runs after the other tables are built: tables under a clear coat read them.
void BsdfTables::build_grain_tables(const std::vector<Material>& materials) {
  for (size_t i = 0; i < materials.size(); ++i) {
    PreparedMaterial& p = materials_[i];
    TableNeeds needs = table_needs(materials[i], p.clear_coat_ior);
    if (!(needs.grain.along > 0)) continue;
    ClearCoat& over = needs.coat_over_grain;
    set_rows(over, p);
    const GgxWidths& a = needs.grain;
    p.grain = nearest_or_new(
        grains_, max_parameters,
        [&](const GrainTable& t) {
          return distance(t.widths.along, a.along) + distance(t.widths.across, a.across) +
                 distance(t.over, over);
        },
        [&] { return make_grain_table(a, over); });
  }
}

void BsdfTables::build_film_glass_tables(const std::vector<Material>& materials) {
  for (size_t i = 0; i < materials.size(); ++i) {
    const Material& m = materials[i];
    PreparedMaterial& p = materials_[i];
    const float alpha = table_needs(m, p.clear_coat_ior).filmed_alpha;
    if (!(alpha > 0) || p.glass < 0) continue;
    const ThinFilm film =
        film_of(m, safe01(m.iridescence.value), safe01(m.film_thickness.value), interference_);
    p.film_glass = nearest_or_new(
        film_glasses_, max_parameters,
        [&](const FilmGlassTable& t) {
          return distance(t.alpha, alpha) + distance(t.ior, p.ior) +
                 distance(t.film.share, film.share) + distance(t.film.ior, film.ior) +
                 distance(t.film.thickness_nm, film.thickness_nm);
        },
        [&] { return make_film_glass_table(alpha, p.ior, film); });
  }
}

Rgb BsdfTables::reflectance_average(Rgb r) const {
  Rgb average;
  for (size_t c = 0; c < 3; ++c) {
    const float x = std::min(std::max(r[c], 0.0f), 1.0f) * float(reflectances - 1);
    const size_t i = std::min(size_t(x), reflectances - 2);
    average[c] = lerp(reflectance_average_[i], reflectance_average_[i + 1], x - float(i));
  }
  return average;
}

}  // namespace troffer
