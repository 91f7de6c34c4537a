// Contributions of one source to sample points, looked up or recomputed after the shots. `kj92`
// uses it to select the sources that it samples again. Irradiance is in W/m² or lx.
#pragma once

#include <span>

#include "light/light_primitive.h"
#include "radiosity/form_factors.h"
#include "radiosity/solution.h"

namespace troffer {

// Returns a shooter of all that a patch shot, its parts weighted by their total irradiance. Points
// into the solution's mesh.
Shooter whole_patch_shooter(const RadiositySolution& solution, uint32_t patch);

// Computes the contributions of one source to any sample points, whether or not it is in their
// lists. Values of a light are bitwise those of its shot. Values of a patch are recomputed in one
// transfer of all its radiance; they differ from the sum over its shots by noise. out[i] belongs to
// points[i] and is zero where the source does not reach. Each thread needs its own scratch.
void source_contributions(const Tracer& tracer, const LightPrimitives& primitives,
                          const RadiositySolution& solution, uint32_t source,
                          std::span<const uint32_t> points, std::span<StoredContribution> out,
                          TransferScratch& scratch);

// Random stream of a light's transfers. A light shoots once, so that its transfers can be
// recomputed.
uint64_t light_stream(const RadiosityOptions& options, uint32_t light);
RayBudget ray_budget(const RadiositySolution& solution, uint32_t source);

}  // namespace troffer
