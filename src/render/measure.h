// Measurement of irradiance (W/m²) and illuminance (lx) at points, with standard errors. The entry
// point measure() chooses between cache cells and paths, and audits cells by paths. Used by the
// commands measure and report, the viewer and the Python module.
#pragma once

#include <cstdint>
#include <vector>

#include "base/parallel.h"
#include "base/rgb.h"
#include "base/vec.h"
#include "render/render.h"

namespace troffer {

struct MeasuringPoint {
  Vec3d position;  // scene units, in the file's coordinates (Scene::origin)
  Vec3 normal;     // on the side that is illuminated; any length but zero
};

struct Measurement {
  Rgb irradiance;  // W/m², or lx per channel in photometric scenes
  double illuminance_lx = 0;
  // of illuminance_lx: 95 % of the intervals illuminance ± 1.96 standard errors hold the true value
  double standard_error = 0;
};

struct MeasureOptions {
  Method method = Method::certified;
  // Samples per point; 0: default_samples(). path: paths. fixed: shadow rays per source. kj92:
  // bintrees per source, and as many rays that gather the radiosity. certified: like kj92, with
  // masks instead of trees.
  int spp = 0;
  double error = 0.01;  // relative error asked for; certified only
  Kj92Settings kj92;
  const Preparation* preparation = nullptr;  // made beforehand; null: made here if needed
  CellStore* cells = nullptr;  // certified: cells from before, updated for later use; may be null
  int depth = -1;
  Indirect indirect = Indirect::automatic;
  int threads = 0;
  uint64_t seed = 0;
};

// Returns a method's number of samples per point if none is asked for.
int default_samples(Method method);

struct MeasureResult {
  std::vector<Measurement> values;  // one per point
  std::vector<bool> is_measured;    // false if a stop was requested before
  Counters counters;
  bool is_complete = true;
  // Indices of points exactly on another surface; they were measured just in front of it.
  std::vector<size_t> in_surfaces;
};

// Measures all points. progress may be empty. After `stop` is set, the result is incomplete.
MeasureResult measure(const PreparedScene& scene, const std::vector<MeasuringPoint>& points,
                      const MeasureOptions& options, const ProgressCallback& progress,
                      const StopFlag& stop);

}  // namespace troffer
