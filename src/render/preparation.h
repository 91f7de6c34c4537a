// What the 1992 method needs before the first viewing ray: the radiosity preprocessing and the
// selection of sources.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "integrate/prepared_scene.h"
#include "integrate/tree_sampling.h"
#include "radiosity/solution.h"
#include "render/progress.h"
#include "select/source_selection.h"

namespace troffer {

struct Kj92Settings {
  RadiosityOptions radiosity;
  SelectionOptions selection;
  TreeSamplingOptions sampling;
};

struct Kj92Preparation {
  RadiositySolution solution;
  SourceSelection selection;
  double seconds = 0;
};

// Solves the radiosity of the scene, or takes `solution` (which must be the scene's), and selects
// sources. is_direct_only: light that has been reflected is not asked for, so that only lights
// shoot. Null once `stop` is set.
std::unique_ptr<Kj92Preparation> prepare_kj92(const PreparedScene& scene,
                                              const Kj92Settings& settings, bool is_direct_only,
                                              std::optional<RadiositySolution> solution,
                                              int threads, const ProgressCallback& progress,
                                              const StopFlag& stop);

// Numbers of the scene's lights that have one of these names, for SelectionOptions::only.
// UsageError names one that does not exist.
std::vector<uint32_t> lights_named(const Scene& scene, const std::vector<std::string>& names);

}  // namespace troffer
