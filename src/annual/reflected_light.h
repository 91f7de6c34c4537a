// Reflected daylight at sensors: illuminance per unit of each source outside (outside_sources.h)
// by way of at least one surface. All sources are right-hand sides of one balance of light on
// cells, E = D + W E, which is solved for blocks of sources.
//
// The calculation runs as a few independent replicates. Their mean is the result. Their spread
// gives its error, from all random numbers together.
//
// References: [1] Tregenza & Waters, "Daylight coefficients", Lighting Research and Technology
//   15(2), 1983.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "annual/outside_sources.h"
#include "annual/state_family.h"
#include "annual/sun_grid.h"
#include "annual/transport_cells.h"
#include "render/progress.h"

namespace troffer {

constexpr int replicate_count = 8;

// Coefficients of one replicate: lx per unit of a source, sensor by sensor.
struct ReflectedReplicate {
  std::shared_ptr<const SunGrid> suns;
  size_t sources = 0;
  size_t cells = 0, links = 0;  // size of its matrix
  std::vector<float> coefficients;

  std::span<const float> of(size_t sensor) const {
    return std::span(coefficients).subspan(sensor * sources, sources);
  }
};

// Keeps finished replicates of all states (reflected_store.h).
class ReplicateKeeper {
 public:
  virtual ~ReplicateKeeper() = default;
  // Sets all but `suns` and `sources` of a replicate that was kept. Returns false otherwise. state:
  // StateOfFamily::number.
  virtual bool find(size_t state, size_t replicate, size_t sensors, ReflectedReplicate& out) = 0;
  // False if another process computes the replicate, which then gets no coefficients here.
  virtual bool is_own(size_t state, size_t replicate) const = 0;
  virtual void keep(size_t state, size_t replicate, const ReflectedReplicate& finished) = 0;
};

struct ReflectedOptions {
  TransportRays rays;
  uint64_t seed = 0;
  int threads = 0;
  int subdivision = reflected_subdivision;  // of the sky; another one only in benchmarks
  ReplicateKeeper* keeper = nullptr;        // may be null
};

// Computes all replicates of the states of a family, state by state. Returns fewer of each once
// `stop` is set. A state's replicates do not depend on which other states are computed. Memory
// besides the results: per thread 400 bytes per cell, and 16 bytes per ray of one replicate.
std::vector<std::vector<ReflectedReplicate>> reflected_light(
    const StateFamily& family, const WeatherYear& year, const Compass& compass,
    const ReflectedOptions& options, const ProgressCallback& progress, const StopFlag& stop);

}  // namespace troffer
