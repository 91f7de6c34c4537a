// Directional albedo of white gloss that is wider along a grain than across it, over the cosine and
// the first harmonic of the azimuth: even(c) + twice(c) cos 2φ. Under a clear coat it is relative
// to the light that the coat passes: 1 minus what stays between microfacets and below the coat.
// add_metal_compensation uses it.
#pragma once

#include <array>

#include "bsdf/albedo_table.h"
#include "bsdf/clear_coat.h"
#include "bsdf/ggx_grained.h"

namespace troffer {

struct GrainTable {
  GgxWidths widths;
  ClearCoat over;  // without its row
  // Two equal rows each, because AlbedoRow interpolates between two.
  std::array<float, 2 * table_cosines> even{}, twice{};
  float average = 0;  // mean of `even`, for AlbedoRow

  AlbedoRow even_row() const { return {even.data(), 0, average}; }
  AlbedoRow twice_row() const { return {twice.data(), 0, 0}; }
};

GrainTable make_grain_table(const GgxWidths& widths, const ClearCoat& over);

// Fills the albedo table of white sheen (bsdf/sheen.h) by its width, clamped to least_sheen_alpha.
void build_sheen_table(AlbedoTable& table);

}  // namespace troffer
