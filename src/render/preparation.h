// Preparation of methods that need the radiosity preprocessing (kj92): the solution and the source
// selection. Made once before the first viewing ray and shared by all integrators of a scene.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "kj92/source_selection.h"
#include "kj92/tree_sampling.h"
#include "methods/methods.h"
#include "radiosity/solution.h"
#include "render/progress.h"
#include "transport/prepared_scene.h"

namespace troffer {

struct Kj92Settings {
  RadiosityOptions radiosity;
  SelectionOptions selection;
  TreeSamplingOptions sampling;
};

struct Preparation {
  RadiositySolution solution;
  SourceSelection selection;
  double seconds = 0;
};

// Solves the radiosity of the scene, or takes `solution`, which must belong to it, and selects
// sources. Returns null if the method needs no preparation (needs_radiosity) or `stop` is set.
std::unique_ptr<Preparation> prepare(const PreparedScene& scene, Method method,
                                     const Kj92Settings& settings, Indirect indirect,
                                     std::optional<RadiositySolution> solution, int threads,
                                     const ProgressCallback& progress, const StopFlag& stop);

// Makes the integrator of a method. preparation and cells may be null if the method does not need
// them (needs_radiosity, needs_cells). Calls `planned`, which may be empty, between planning and
// preparing. Scene and preparation must outlive the integrator. Returns null if CellInput::stop was
// set.
std::unique_ptr<Integrator> make_integrator(
    const PreparedScene& scene, Method method, const MethodSettings& settings,
    const Preparation* preparation, CellInput* cells,
    const std::function<void(const MethodPlan&)>& planned = nullptr);

// Returns the indices of lights with one of these names, for SelectionOptions::only. Throws
// UsageError for a name that does not exist.
std::vector<uint32_t> lights_named(const Scene& scene, const std::vector<std::string>& names);

}  // namespace troffer
