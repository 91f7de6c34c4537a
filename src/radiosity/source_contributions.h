// What one source gave, looked up or computed again after the shots.
#pragma once

#include <span>

#include "light/light_primitive.h"
#include "radiosity/form_factors.h"
#include "radiosity/solution.h"

namespace troffer {

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

// Random numbers of a light's transfers. A light shoots once, so that they can be computed again.
uint64_t light_stream(const RadiosityOptions& options, uint32_t light);
RayBudget ray_budget(const RadiositySolution& solution, uint32_t source);

}  // namespace troffer
