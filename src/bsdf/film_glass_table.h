// Directional albedo of rough solid glass under a thin film that is the same everywhere, from both
// sides: the mean of the channels by the cosine, and what each of them loses in all.
#pragma once

#include <array>

#include "bsdf/albedo_table.h"
#include "bsdf/thin_film.h"

namespace troffer {

struct FilmGlassTable {
  float alpha = 0, ior = 1;
  ThinFilm film;
  struct Side {
    // Two equal rows, as AlbedoRow reads them.
    std::array<float, 2 * table_cosines> values{};
    float average = 0;
    Rgb lost{1};  // of each channel, over the mean of all
    AlbedoRow row() const { return {values.data(), 0, average}; }
  };
  Side outside, inside;
  Rgb reflected;  // cosine-weighted mean reflectance from outside
};

// Some hundredths of a second.
FilmGlassTable make_film_glass_table(float alpha, float ior, const ThinFilm& film);

}  // namespace troffer
