#include "bsdf/thin_film.h"

#include "base/observer.h"
#include "base/units.h"

namespace troffer {

InterferenceTable make_interference_table() {
  InterferenceTable table;
  table.values.resize(InterferenceTable::count);
  std::vector<Rgb> seen;  // by wavelength
  Rgb white;
  for (int nm = least_visible_nm; nm <= most_visible_nm; ++nm) {
    seen.push_back(rgb_from_xyz(color_matching(nm)));
    white += seen.back();
  }
  for (size_t i = 0; i < table.values.size(); ++i) {
    const double difference = double(InterferenceTable::step_nm) * double(i);
    Rgb sum;
    for (size_t k = 0; k < seen.size(); ++k)
      sum += seen[k] * float(std::cos(2 * pi * difference / double(least_visible_nm + int(k))));
    table.values[i] = sum / white;
  }
  return table;
}

namespace {

// Cosines on both sides of an interface, and the index of the second side over the first.
struct Interface {
  float cos_1, cos_2, eta;
  float perpendicular() const { return (cos_1 - eta * cos_2) / (cos_1 + eta * cos_2); }
  float parallel() const { return (eta * cos_1 - cos_2) / (eta * cos_1 + cos_2); }
};

}  // namespace

Rgb film_reflectance(const ThinFilm& film, Rgb f0, float cosine) {
  constexpr int most_orders = 32;
  constexpr float negligible_order = 2e-4f;
  const float c = std::clamp(cosine, 1e-4f, 1.0f), s2 = 1 - c * c;
  const float inside = std::sqrt(std::max(0.0f, 1 - s2 / sqr(film.ior)));
  const float difference = 2 * film.ior * film.thickness_nm * inside;
  const Interface top{c, inside, film.ior};
  Rgb out;
  Rgb means[most_orders];
  int known = 0;
  for (size_t k = 0; k < 3; ++k) {
    const float base = index_from_reflectance(f0[k]);
    const Interface bottom{inside, std::sqrt(std::max(0.0f, 1 - s2 / sqr(base))), base / film.ior};
    for (const bool is_parallel : {false, true}) {
      const float r12 = is_parallel ? top.parallel() : top.perpendicular();
      const float r23 = is_parallel ? bottom.parallel() : bottom.perpendicular();
      const float q = r12 * r23;
      float series = 1, power = 1;
      for (int m = 0; m < most_orders; ++m) {
        power *= -q;
        if (std::abs(power) < negligible_order) break;
        if (m == known) means[known++] = film.table->at(difference * float(m + 1));
        series += 2 * power * means[m][k];
      }
      const float passed = (1 - r12 * r12) * (1 - r23 * r23) / std::max(1 - q * q, 1e-6f);
      out[k] += 0.5f * (1 - passed * series);
    }
  }
  // Colours of narrow bands can lie outside sRGB.
  return {std::clamp(out.r, 0.0f, 1.0f), std::clamp(out.g, 0.0f, 1.0f),
          std::clamp(out.b, 0.0f, 1.0f)};
}

}  // namespace troffer
