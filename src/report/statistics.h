// What a grid of measured points says: mean, least value, uniformity, each with a standard error.
#pragma once

#include <vector>

namespace troffer {

// A figure and its standard error, in the figure's unit.
struct Figure {
  double value = 0, error = 0;
};

struct GridSummary {
  Figure mean, least, most;
  Figure uniformity;  // least over mean
  // By how much the least of noisy values lies below the least of true ones, about: what another
  // noise as large as the told errors would take off.
  double least_bias = 0;
  bool has_values = false;  // there is a point
};

// Mean of figures. Errors of points measured together may have a part in common, which no mean
// takes away: the error told is the mean of theirs, an upper bound.
Figure mean_of(const std::vector<Figure>& values);

Figure ratio(const Figure& a, const Figure& b);  // as if independent; 0 where b is 0
inline Figure scaled(const Figure& f, double by) {
  return {f.value * by, f.error * by};
}
Figure sum(const Figure& a, const Figure& b);  // as if independent

GridSummary summary_of(const std::vector<Figure>& values);

}  // namespace troffer
