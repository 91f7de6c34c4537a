#include "render/preparation.h"

#include <chrono>

#include "base/error.h"
#include "render/radiosity.h"
#include "scene/names.h"

namespace troffer {

std::unique_ptr<Preparation> prepare(const PreparedScene& scene, Method method,
                                     const Kj92Settings& settings, Indirect indirect,
                                     std::optional<RadiositySolution> solution, int threads,
                                     const ProgressCallback& progress, const StopFlag& stop) {
  if (!needs_radiosity(method, indirect)) return nullptr;
  const bool is_direct_only = indirect == Indirect::none;
  const auto start = std::chrono::steady_clock::now();
  if (!solution) {
    RadiosityOptions options = settings.radiosity;
    if (is_direct_only) options.unshot_fraction = 1;  // only lights shoot
    solution = preprocess(scene, options, threads, progress, stop).solution;
  }
  if (stop.load()) return nullptr;
  SelectionOptions selection = settings.selection;
  if (is_direct_only) selection.uses_patches = false;
  SourceSelection selected(*solution, scene.tracer, scene.primitives, selection, threads, stop);
  if (stop.load()) return nullptr;
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  return std::make_unique<Preparation>(
      Preparation{std::move(*solution), std::move(selected), seconds.count()});
}

std::unique_ptr<Integrator> make_integrator(const PreparedScene& scene, Method method,
                                            const MethodSettings& settings,
                                            const Preparation* preparation, CellInput* cells,
                                            const std::function<void(const MethodPlan&)>& planned) {
  std::optional<RadiosityLight> radiosity;
  if (preparation != nullptr)
    radiosity.emplace(scene, preparation->solution, preparation->selection);
  const MethodInput input{scene, settings, radiosity ? &*radiosity : nullptr, cells};
  const MethodPlan plan = plan_method(method, input);
  if (planned) planned(plan);
  return make_integrator(method, plan, input);
}

std::vector<uint32_t> lights_named(const Scene& scene, const std::vector<std::string>& names) {
  std::vector<uint32_t> lights;
  for (const std::string& name : names) {
    bool is_found = false;
    for (uint32_t e = 0; e < scene.lights.size(); ++e)
      if (scene.lights[e].name == name) {
        lights.push_back(e);
        is_found = true;
      }
    if (!is_found) throw UsageError(no_light_named(scene, name));
  }
  return lights;
}

}  // namespace troffer
