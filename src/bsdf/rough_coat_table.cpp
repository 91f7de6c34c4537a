#include "bsdf/rough_coat_table.h"

#include <algorithm>

#include "base/units.h"

namespace troffer {

RoughCoatTable make_rough_coat_table(FacetShape shape, float alpha, float ior) {
  RoughCoatTable table;
  table.shape = shape;
  table.alpha = alpha;
  table.ior = ior;
  for (size_t k = 0; k < table_cosines; ++k) {
    const float c = sqr(sqr(float(k) / float(table_cosines - 1)));
    const RoughShares s = rough_shares(shape, double(alpha), double(ior), double(c));
    table.held_back[k] = float(std::clamp(1 - s.through, 0.0, 1.0));
    table.reflected[k] = float(std::min(s.reflected, 1.0));
    table.held_back[k + table_cosines] = table.held_back[k];
    table.reflected[k + table_cosines] = table.reflected[k];
  }
  table.mean_held_back = row_average(table.held_back.data());
  table.mean_reflected = row_average(table.reflected.data());
  table.reflected_inside = mean_rough_reflectance_inside(shape, double(alpha), double(ior));
  return table;
}

}  // namespace troffer
