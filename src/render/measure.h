// Irradiance and illuminance at points.
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
  Vec3 normal;     // the side that is lit; any length but zero
};

struct Measurement {
  Rgb irradiance;  // W/m², or lx per channel where the scene is photometric
  double illuminance_lx = 0;
  double standard_error = 0;  // of illuminance_lx, such that 95 % of the intervals
                              // illuminance ± 1.96 standard errors hold the true value
};

struct MeasureOptions {
  Method method = Method::certified;
  // Samples per point: paths, or (fixed) shadow rays per source, or (kj92) bintrees for every
  // source and as many rays that gather the radiosity around; certified: as kj92, with masks in
  // place of trees. 0: default_samples().
  int spp = 0;
  double error = 0.01;  // certified
  Kj92Settings kj92;
  const Preparation* preparation = nullptr;  // made beforehand; null: made here if needed
  CellStore* cells = nullptr;  // certified: kept from before, and kept for later; may be null
  int depth = -1;
  Indirect indirect = Indirect::automatic;
  int threads = 0;
  uint64_t seed = 0;
};

// Samples per point of a method where none are asked for.
int default_samples(Method method);

struct MeasureResult {
  std::vector<Measurement> values;  // one per point
  std::vector<bool> is_measured;    // false where a stop was requested before
  Counters counters;
  bool is_complete = true;
  // Points that stood exactly in a surface not their own; measured just before its front.
  std::vector<size_t> in_surfaces;
};

MeasureResult measure(const PreparedScene& scene, const std::vector<MeasuringPoint>& points,
                      const MeasureOptions& options, const ProgressCallback& progress,
                      const StopFlag& stop);

}  // namespace troffer
