// Directional albedo of white gloss that is wider along a grain than across it, over the cosine
// and, to the first harmonic, the azimuth: even(c) + twice(c) cos 2φ. Under a clear coat, of what
// that lets through: 1 less what stays between microfacets and below the coat.
#pragma once

#include <array>

#include "bsdf/albedo_table.h"
#include "bsdf/clear_coat.h"
#include "bsdf/ggx_grained.h"

namespace troffer {

struct GrainTable {
  GgxWidths widths;
  ClearCoat over;  // without its row
  // Two equal rows each, as AlbedoRow reads them.
  std::array<float, 2 * table_cosines> even{}, twice{};
  float average = 0;  // of even

  AlbedoRow even_row() const { return {even.data(), 0, average}; }
  AlbedoRow twice_row() const { return {twice.data(), 0, 0}; }
};

GrainTable make_grain_table(const GgxWidths& widths, const ClearCoat& over);

// Of white sheen (bsdf/sheen.h), by its width; below least_sheen_alpha as there.
void build_sheen_table(AlbedoTable& table);

}  // namespace troffer
