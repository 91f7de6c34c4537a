// Directional albedo of rough solid glass under a uniform thin film, from both sides: the channels'
// mean over the cosine, and the total loss of each channel. BsdfTables owns the tables, and
// add_glass_compensation() uses them to return lost energy.
#pragma once

#include <array>

#include "bsdf/albedo_table.h"
#include "bsdf/thin_film.h"

namespace troffer {

struct FilmGlassTable {
  float alpha = 0, ior = 1;
  ThinFilm film;
  struct Side {
    // Two equal rows, because AlbedoRow interpolates between two.
    std::array<float, 2 * table_cosines> values{};
    float average = 0;
    Rgb lost{1};  // loss of each channel over the mean loss
    AlbedoRow row() const { return {values.data(), 0, average}; }
  };
  Side outside, inside;
  Rgb reflected;  // cosine-weighted mean reflectance from outside
};

// Takes some hundredths of a second.
FilmGlassTable make_film_glass_table(float alpha, float ior, const ThinFilm& film);

}  // namespace troffer
