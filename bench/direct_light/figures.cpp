#include "figures.h"

#include <algorithm>
#include <cmath>

namespace troffer::bench {

Figures figures_of(const Pairs& p, const Answers& answers) {
  Figures f;
  std::vector<double> off;  // errors of the irradiance of a tile's hits
  double light = 0, light2 = 0;
  for (size_t t = 0; t < p.tiles.size(); ++t) {
    off.assign(p.tiles[t].size(), 0);
    for (size_t s = 0; s < p.scene.sources.size(); ++s)
      for (size_t r = 0; r < p.tiles[t].size(); ++r) {
        const size_t i = p.index(t, s, r);
        if (p.is_counted[i] == 0) continue;
        const double e = double(answers.visible[i]) - double(p.reference[i]);
        const double unoccluded = p.scene.radiance[s] * p.unoccluded[i];
        f.rms += e * e;
        f.mean += e;
        f.mean_size += std::abs(e);
        f.worst = std::max(f.worst, std::abs(e));
        f.predicted += double(answers.variance[i]);
        off[r] += unoccluded * e;
        light += unoccluded;
      }
    for (const double e : off) light2 += e * e;
  }
  const auto n = double(p.counted), hits = double(p.hits);
  f.rms = std::sqrt(f.rms / n);
  f.mean /= n;
  f.mean_size /= n;
  f.predicted = std::sqrt(f.predicted / n);
  f.rms_light = std::sqrt(light2 / hits) / (light / hits);
  return f;
}

KindFigures figures_of_kind(const Pairs& p, const Answers& answers, ShadowAnswer kind) {
  KindFigures f;
  for (size_t i = 0; i < p.size(); ++i) {
    if (p.is_counted[i] == 0 || answers.kinds[i] != kind) continue;
    const double e = double(answers.visible[i]) - double(p.reference[i]);
    f.rms += e * e;
    f.predicted += double(answers.variance[i]);
    ++f.pairs;
  }
  const auto n = double(std::max<size_t>(f.pairs, 1));
  f.rms = std::sqrt(f.rms / n);
  f.predicted = std::sqrt(f.predicted / n);
  return f;
}

double worst_where_open(const Pairs& p, const Answers& answers) {
  double worst = 0;
  for (size_t i = 0; i < p.size(); ++i) {
    if (p.is_counted[i] == 0 || p.reference[i] != 1) continue;
    const double value = double(answers.unoccluded[i]) * double(answers.visible[i]);
    worst = std::max(worst, std::abs(value / p.unoccluded[i] - 1));
  }
  return worst;
}

size_t contradictions(const Pairs& p, const Answers& answers) {
  size_t count = 0;
  for (size_t i = 0; i < p.size(); ++i) {
    if (p.is_counted[i] == 0) continue;
    count += answers.kinds[i] == ShadowAnswer::lit && p.reference[i] < 1 ? 1 : 0;
    count += answers.kinds[i] == ShadowAnswer::dark && p.reference[i] > 0 ? 1 : 0;
  }
  return count;
}

}  // namespace troffer::bench
