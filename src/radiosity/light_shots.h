// Transfer of one light to all sample points, and the share of its light that leaves the scene. The
// solver shoots each light once with it. Power is in W or lm, as the lights'.
#pragma once

#include <span>
#include <vector>

#include "base/parallel.h"
#include "radiosity/closure.h"
#include "radiosity/form_factors.h"
#include "radiosity/solution.h"

namespace troffer {

struct LightShot {
  double power = 0;
  OpenShare open;  // not set for closed scenes
  bool has_surface = false;
};

class LightShots {
 public:
  // Prepares shots for a solution, using its mesh, options and mean irradiance.
  LightShots(const Tracer& tracer, const LightPrimitives& primitives,
             const RadiositySolution& solution, int threads);

  // Computes the transfers of a light. Does nothing for a light without a surface, or once `stop`
  // is set.
  LightShot shoot(uint32_t light, bool is_closed, const StopFlag& stop);
  std::span<const Transfer> transfers() const { return transfers_; }  // last shot, per point
  uint64_t rays() const;

 private:
  // Sample points processed together, and the rays they took.
  struct Chunk {
    uint32_t first = 0, last = 0;
    uint64_t rays = 0;
  };
  void find_transfers(const Shooter& shooter, uint32_t light, uint64_t stream,
                      const StopFlag& stop);

  const Tracer& tracer_;
  const LightPrimitives& lights_;
  const RadiositySolution& solution_;
  int threads_;
  std::vector<Chunk> chunks_;
  std::vector<Transfer> transfers_;
  std::vector<TransferScratch> scratch_;
};

}  // namespace troffer
