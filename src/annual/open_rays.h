// Shadow rays from places to directions outside the scene. Light from there arrives if nothing
// except panes is in the way. Used for direct light of sensors and of cells.
#pragma once

#include <cstdint>
#include <vector>

#include "cells/cell_hit.h"
#include "trace/tracer.h"

namespace troffer {

class OpenRays {
 public:
  static constexpr size_t enough = 4096;  // rays that callers collect before they trace them

  explicit OpenRays(const Tracer& tracer) : tracer_(tracer) {}

  void clear() { rays_.clear(); }
  size_t size() const { return rays_.size(); }
  // Adds a ray from a place towards a unit direction above its horizon. Returns it.
  const Ray& add(const CellHit& from, const Vec3& direction);
  void add(const Ray& ray) { rays_.push_back(ray); }
  // Traces the rays.
  void trace();
  // Transmittance of the panes on a ray, or black if something else is in the way.
  Rgb operator[](size_t i) const { return is_occluded_[i] != 0 ? Rgb{0} : factors_[i]; }

 private:
  const Tracer& tracer_;
  std::vector<Ray> rays_;
  std::vector<uint8_t> is_occluded_;
  PaneFactors factors_;
};

}  // namespace troffer
