// The default method, from its plan to an integrator: certified direct light, with cells, paths or
// nothing for reflected light. References: docs/method/certified.md, docs/method/cells.md.
#pragma once

#include <memory>

#include "methods/methods.h"

namespace troffer {

// Prepares what the plan asks for (occluders, mirror images, cells, fits) and makes the integrator.
// Returns null after a stop, or if there are too many cells and no forecast for paths.
std::unique_ptr<Integrator> make_certified(const MethodPlan& plan, const MethodInput& in);

// Plans and makes path tracing that ends at cells.
MethodPlan plan_cached_path(const MethodInput& in);
std::unique_ptr<Integrator> make_cached_path(const MethodPlan& plan, const MethodInput& in);

}  // namespace troffer
