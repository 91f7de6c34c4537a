// A rough coat of one width over a diffuse base, whose microfacets scatter once
// (FacetModel::single_ggx, single_beckmann): Mitsuba's roughplastic. Light is lost between facets
// on the way in and on the way out. BsdfTables owns the tables; values are shares of energy over
// the cosine.
#pragma once

#include <array>

#include "base/facets.h"
#include "bsdf/albedo_table.h"

namespace troffer {

struct RoughCoatTable {
  FacetShape shape = FacetShape::ggx;
  float alpha = 0, ior = 1;
  // Over the cosine: 1 - the light that reaches the base, and the light that the coat reflects. Two
  // equal rows each, because AlbedoRow interpolates between two.
  std::array<float, 2 * table_cosines> held_back{}, reflected{};
  float mean_held_back = 0, mean_reflected = 0;
  float reflected_inside = 0;  // mean over diffuse light from below

  AlbedoRow held_back_row() const { return {held_back.data(), 0, mean_held_back}; }
  AlbedoRow reflected_row() const { return {reflected.data(), 0, mean_reflected}; }
};

RoughCoatTable make_rough_coat_table(FacetShape shape, float alpha, float ior);

}  // namespace troffer
