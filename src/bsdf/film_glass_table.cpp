#include "bsdf/film_glass_table.h"

#include <algorithm>

#include "bsdf/fresnel.h"

namespace troffer {

namespace {

FilmGlassTable::Side side_of(const std::array<Rgb, table_cosines>& albedos) {
  FilmGlassTable::Side side;
  std::array<float, table_cosines> channel;
  Rgb lost;
  for (size_t c = 0; c < 3; ++c) {
    for (size_t k = 0; k < table_cosines; ++k) channel[k] = std::min(albedos[k][c], 1.0f);
    lost[c] = 1 - row_average(channel.data());
  }
  for (size_t k = 0; k < table_cosines; ++k)
    side.values[k] = side.values[k + table_cosines] = std::min(average(albedos[k]), 1.0f);
  side.average = row_average(side.values.data());
  const float mean = average(lost);
  if (mean > 0) side.lost = lost / mean;
  return side;
}

}  // namespace

FilmGlassTable make_film_glass_table(float alpha, float ior, const ThinFilm& film) {
  FilmGlassTable table;
  table.alpha = alpha;
  table.ior = ior;
  table.film = film;
  ReflectanceCurve curve;
  const Rgb f0{normal_reflectance(ior)};
  for (size_t i = 0; i < curve.size(); ++i) {
    const float t = float(i) / float(curve.size() - 1), c = std::max(t * t, 1e-6f);
    const Rgb plain{fresnel_dielectric(c, ior)};
    curve[i] = plain + (film_reflectance(film, f0, c) - plain) * film.share;
    // 2 c dc = 4 t³ dt, by the trapezoidal rule
    const float weight = i + 1 == curve.size() ? 0.5f : 1.0f;
    table.reflected += curve[i] * (4 * t * t * t * weight / float(curve.size() - 1));
  }
  table.outside = side_of(glass_albedos(alpha, ior, false, curve));
  table.inside = side_of(glass_albedos(alpha, 1 / ior, true, curve));
  return table;
}

}  // namespace troffer
