#include "bsdf/tables.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "bsdf/facet_lobe.h"
#include "bsdf/fresnel.h"
#include "bsdf/material_inputs.h"

namespace troffer {

namespace {

float safe_ior(float ior) {
  return std::isfinite(ior) && ior > 0 ? std::clamp(ior, 0.01f, 100.0f) : 1.5f;
}

// Returns the index of the table for this ior. Makes one while there is room; otherwise returns the
// nearest.
template <class Table>
int32_t table_for(std::vector<Table>& tables, float ior, size_t max_tables) {
  size_t nearest = 0;
  float distance = std::numeric_limits<float>::infinity();
  for (size_t i = 0; i < tables.size(); ++i) {
    const float d = std::abs(std::log(tables[i].ior / ior));
    if (d < distance) {
      distance = d;
      nearest = i;
    }
  }
  if (distance < 1e-4f || tables.size() >= max_tables) return int32_t(nearest);
  tables.emplace_back();
  tables.back().ior = ior;
  return int32_t(tables.size() - 1);
}

bool is_same(const ClearCoat& a, const ClearCoat& b) {
  return a.share == b.share && a.alpha == b.alpha && a.eta == b.eta && a.bend == b.bend;
}

int32_t grain_for(std::vector<GrainTable>& tables, const GgxWidths& a, const ClearCoat& over,
                  size_t max_tables) {
  for (size_t i = 0; i < tables.size(); ++i)
    if (tables[i].widths.along == a.along && tables[i].widths.across == a.across &&
        is_same(tables[i].over, over))
      return int32_t(i);
  if (tables.size() >= max_tables) return -1;
  tables.push_back(make_grain_table(a, over));
  return int32_t(tables.size() - 1);
}

// True if alpha lets a share of the light straight through. Shadow rays then pass it like a pane.
bool is_blended(const Material& m) {
  return m.is_alpha_masked && m.is_alpha_blended && (m.alpha.texture >= 0 || m.alpha.value < 1);
}

}  // namespace

BsdfTables::BsdfTables(const std::vector<Material>& materials) {
  bool needs_ggx = false, needs_sheen = false, needs_film = false;
  for (const Material& m : materials) {
    PreparedMaterial p;
    p.ior = safe_ior(m.ior);
    p.clear_coat_ior = safe_ior(m.coat_ior);
    p.is_pane = is_pane(m) || is_blended(m);
    const TableNeeds needs = table_needs(m, p.clear_coat_ior);
    needs_ggx |= needs.has_ggx;
    needs_sheen |= needs.has_sheen;
    needs_film |= needs.has_film;
    if (needs.has_coat) p.coat = table_for(coats_, p.ior, max_iors);
    if (needs.single_coat_alpha > 0)
      p.rough_coat = rough_coat_for(m, needs.single_coat_alpha, p.ior);
    if (needs.has_clear_coat) p.clear_coat = table_for(coats_, p.clear_coat_ior, max_iors);
    if (needs.has_clear_inside)
      p.clear_inside = table_for(coats_, 1 / p.clear_coat_ior, 2 * max_iors);
    if (needs.has_glass && std::abs(p.ior - 1) >= index_matched)
      p.glass = table_for(glasses_, p.ior, max_iors);
    if (needs.has_dielectric_average) {
      p.dielectric_average = fresnel_dielectric_average(p.ior);
      p.plate_average = plate_reflectance_average(p.ior);
    }
    if (needs.has_conductor_average) {
      const Rgb eta = safe_index(m.eta), k = safe_index(m.k);
      for (size_t c = 0; c < 3; ++c)
        p.conductor_average[c] = fresnel_conductor_average(eta[c], k[c]);
    }
    materials_.push_back(p);
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

// Beyond max_iors tables it returns -1, and the coat is treated as balanced.
int32_t BsdfTables::rough_coat_for(const Material& m, float alpha, float ior) {
  const FacetShape shape = shape_of(m.facets);
  for (size_t i = 0; i < rough_coats_.size(); ++i)
    if (rough_coats_[i].shape == shape && rough_coats_[i].alpha == alpha &&
        rough_coats_[i].ior == ior)
      return int32_t(i);
  if (rough_coats_.size() >= max_iors) return -1;
  rough_coats_.push_back(make_rough_coat_table(shape, alpha, ior));
  return int32_t(rough_coats_.size() - 1);
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
    p.grain = grain_for(grains_, needs.grain, over, max_iors);
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
    const auto found =
        std::find_if(film_glasses_.begin(), film_glasses_.end(), [&](const FilmGlassTable& t) {
          return t.alpha == alpha && t.ior == p.ior && t.film.share == film.share &&
                 t.film.ior == film.ior && t.film.thickness_nm == film.thickness_nm;
        });
    if (found == film_glasses_.end() && film_glasses_.size() >= max_iors) continue;
    p.film_glass = int32_t(found - film_glasses_.begin());
    if (found == film_glasses_.end())
      film_glasses_.push_back(make_film_glass_table(alpha, p.ior, film));
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
