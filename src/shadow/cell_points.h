// Maps the unit square to a flat cell so that equal areas stay equal. Rays to a source use it to
// choose their end points.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "base/units.h"
#include "shadow/cut_cells.h"

namespace troffer {

// Keeps a reference to the cell, which must outlive it.
class CellPoints {
 public:
  explicit CellPoints(const FlatCell& cell) : cell_(cell) {
    const auto corners = cell.all_corners();
    if (cell.is_disk || cell.count == 0) {
      area_ = length(cross(cell.plane.u, cell.plane.v)) * (cell.is_disk ? 0.25 * pi : 1);
      return;
    }
    for (size_t i = 1; i + 1 < corners.size(); ++i) {
      area_ += 0.5 * length(cross(corners[i] - corners[0], corners[i + 1] - corners[0]));
      ends_[i] = float(area_);
    }
  }
  // Returns the area of the cell in m².
  double area() const { return area_; }
  // Returns the point for u, v in [0,1).
  Vec3d at(float u, float v) const {
    const Parallelogram& p = cell_.plane;
    if (cell_.is_disk) {
      const double radius = 0.5 * std::sqrt(double(u)), angle = 2 * pi * double(v);
      return p.origin + p.u * (0.5 + radius * std::cos(angle)) +
             p.v * (0.5 + radius * std::sin(angle));
    }
    if (cell_.count == 0) return p.origin + p.u * double(u) + p.v * double(v);
    const auto c = cell_.all_corners();
    const float wanted = u * float(area_);
    size_t i = 1;
    while (i + 2 < c.size() && wanted >= ends_[i]) ++i;
    const float first = i > 1 ? ends_[i - 1] : 0;
    const double along =
        double(std::clamp((wanted - first) / std::max(ends_[i] - first, 1e-30f), 0.0f, 1.0f));
    const double out = std::sqrt(double(v));
    return c[0] + ((c[i] - c[0]) * (1 - along) + (c[i + 1] - c[0]) * along) * out;
  }

 private:
  const FlatCell& cell_;
  double area_ = 0;
  std::array<float, most_source_corners> ends_{};  // running sum of the fan's triangle areas, m²
};

}  // namespace troffer
