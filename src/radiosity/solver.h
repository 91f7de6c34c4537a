// Progressive radiosity with substructuring [1]: patches shoot, sample points of elements receive.
// `troffer radiosity` and `kj92` run it before rendering.
//
// Each light shoots once. Then the patch with the largest unshot power shoots, repeatedly. This
// ends when the unshot power is below a fraction of the light that reached diffuse surfaces
// directly from lights. Every shot is corrected (closure.h) so that no more power arrives than was
// sent, and surfaces absorb at least a thousandth of it. The unshot power therefore falls with
// every shot.
//
// References:
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
  double unshot = 1;  // unshot fraction of the emitted power
  double done = 0;    // progress, 0 to 1
};

// Called after every shot, in the thread that called solve_radiosity.
using RadiosityCallback = std::function<void(const RadiosityProgress&)>;

// Computes the solution; all arguments belong to `scene`. The result does not depend on `threads`
// (0 = all cores). Once `stop` is set, it returns the solution so far without the current shot,
// with is_complete = false.
RadiositySolution solve_radiosity(const Scene& scene, const Tracer& tracer,
                                  const BsdfTables& tables, const LightPrimitives& primitives,
                                  const RadiosityOptions& options, int threads,
                                  const RadiosityCallback& progress, const StopFlag& stop);

}  // namespace troffer
