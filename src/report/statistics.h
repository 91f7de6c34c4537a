// Statistics of a grid of measured points: mean, minimum, maximum and uniformity, each with a
// standard error. Assessments, tables and plots of reports use it.
#pragma once

#include <vector>

namespace troffer {

// A figure and its standard error, in the figure's unit.
struct Figure {
  double value = 0, error = 0;
};

// Summary of a grid; figures have the unit of the points.
struct GridSummary {
  Figure mean, least, most;
  Figure uniformity;  // least over mean
  // Estimated bias of the minimum: how much lower the minimum of noisy values is than that of exact
  // ones. At most 0.
  double least_bias = 0;
  bool has_values = false;  // false if there is no point
};

// Returns the mean of figures. Its error is the mean of their errors, an upper bound: points that
// are measured together may share a part of their error, which does not average out.
Figure mean_of(const std::vector<Figure>& values);

Figure ratio(const Figure& a, const Figure& b);  // for independent figures; 0 if b is not above 0
inline Figure scaled(const Figure& f, double by) {
  return {f.value * by, f.error * by};
}
Figure sum(const Figure& a, const Figure& b);  // for independent figures

GridSummary summary_of(const std::vector<Figure>& values);

}  // namespace troffer
