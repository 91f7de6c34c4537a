// Progressive radiosity with substructuring: patches shoot, sample points of elements receive.
//
// Lights shoot first, each once; then, again and again, the patch with the largest unshot power,
// until what is unshot falls under a fraction of what came to diffuse surfaces straight from
// lights. Every shot is closed (closure.h): no more power arrives than was sent, and of what
// arrives at least a thousandth is absorbed; so the unshot power falls with every shot. References:
// [1] Cohen, Chen, Wallace & Greenberg, "A Progressive Refinement Approach to Fast
//   Radiosity Image Generation", SIGGRAPH 1988. [2] Kok & Jansen, "Source Selection for the Direct
//   Lighting Computation in Global Illumination", EG Workshop on Rendering 1991 (contributions kept
//   by source).
#pragma once

#include <functional>

#include "base/parallel.h"
#include "light/light_primitive.h"
#include "radiosity/solution.h"

namespace troffer {

struct RadiosityProgress {
  uint32_t shots = 0;
  double unshot = 1;  // fraction of the emitted power that is unshot
  double done = 0;    // of the way to the end, 0 … 1
};

// Called after every shot, from the thread that called solve_radiosity.
using RadiosityCallback = std::function<void(const RadiosityProgress&)>;

// The arguments belong to `scene`. The result does not depend on `threads` (0 = all cores). Once
// `stop` is set, the solution so far comes back without the current shot, with is_complete = false.
RadiositySolution solve_radiosity(const Scene& scene, const Tracer& tracer,
                                  const BsdfTables& tables, const LightPrimitives& primitives,
                                  const RadiosityOptions& options, int threads,
                                  const RadiosityCallback& progress, const StopFlag& stop);

}  // namespace troffer
