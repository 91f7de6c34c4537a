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
#include "radiosity/form_factors.h"
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

// All that a patch shot, its parts in the proportions of what they received in all; points into the
// solution's mesh.
Shooter whole_patch_shooter(const RadiositySolution& solution, uint32_t patch);

// What one source gave to any sample points, whether it is in their lists or not. A light's
// values are those of its shot, bit for bit. A patch's are computed anew, in one transfer of all
// the radiance that it shot: they differ from the sum over its shots by noise. out[i] is for
// points[i]; points that the source cannot reach get zeros. Each thread needs a scratch of its own.
void source_contributions(const Tracer& tracer, const LightPrimitives& primitives,
                          const RadiositySolution& solution, uint32_t source,
                          std::span<const uint32_t> points, std::span<StoredContribution> out,
                          TransferScratch& scratch);

}  // namespace troffer
