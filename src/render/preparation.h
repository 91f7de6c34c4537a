// What methods that stand on the radiosity preprocessing need before the first viewing ray: it, and
// the selection of sources.
#pragma once

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

// Solves the radiosity of the scene, or takes `solution` (which must be the scene's), and selects
// sources. Null where the method needs nothing (needs_radiosity), and once `stop` is set.
std::unique_ptr<Preparation> prepare(const PreparedScene& scene, Method method,
                                     const Kj92Settings& settings, Indirect indirect,
                                     std::optional<RadiositySolution> solution, int threads,
                                     const ProgressCallback& progress, const StopFlag& stop);

// preparation, cells: may be null where the method needs none (needs_radiosity, needs_cells); the
// preparation must outlive the integrator, as must scene. Null where CellInput::stop was set.
std::unique_ptr<Integrator> make_integrator(const PreparedScene& scene, Method method,
                                            const MethodSettings& settings,
                                            const Preparation* preparation, CellInput* cells);

// Numbers of the scene's lights that have one of these names, for SelectionOptions::only.
// UsageError names one that does not exist.
std::vector<uint32_t> lights_named(const Scene& scene, const std::vector<std::string>& names);

}  // namespace troffer
