#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "app/commands.h"
#include "app/progress.h"
#include "app/solution_file.h"
#include "base/error.h"
#include "image/read_image.h"
#include "render/framing.h"
#include "render/radiosity.h"

namespace troffer {

void check_method(Method method, Indirect indirect, const std::string& solution) {
  const bool is_usual = indirect == Indirect::automatic || indirect == Indirect::none ||
                        indirect == method.row().usual_indirect;
  if (!is_usual)
    throw UsageError(fmt::format("--indirect {} belongs to --method {}", indirect.row().name,
                                 indirect == Indirect::radiosity ? "kj92" : "certified"));
  if (!solution.empty() && !needs_radiosity(method, indirect) && !needs_cells(method, indirect))
    throw UsageError(method.row().usual_indirect != Indirect::none
                         ? "--solution does not go with --indirect none: there is nothing to store"
                         : "--solution belongs to --method kj92 and certified");
}

void warn_of_lights_left_out(const PreparedScene& scene, bool is_quiet) {
  const std::string text = lights_left_out(scene.scene);
  if (!is_quiet && !text.empty()) fmt::print(stderr, "warning: {}\n", text);
}

namespace {

// Warns that kj92 counts light as absent if its first rays miss it.
void warn_of_openings(const PreparedScene& scene, const Kj92Settings& settings) {
  const bool has_far = std::any_of(
      scene.scene.lights.begin(), scene.scene.lights.end(),
      [](const Light& e) { return e.kind == LightKind::sky || e.kind == LightKind::environment; });
  const BintreeOptions& tree = settings.sampling.tree;
  if (has_far && tree.allowed_variance > 0 && is_room(scene))
    fmt::print(stderr,
               "warning: kj92 misses much of the sky light that enters through openings (two "
               "fifths through a window); other methods compute all of it\n");
}

}  // namespace

std::unique_ptr<Preparation> prepare_method(const PreparedScene& scene, Method method,
                                            const Kj92Settings& settings, Indirect indirect,
                                            const std::string& solution, int threads, bool is_quiet,
                                            const StopFlag& stop) {
  if (!needs_radiosity(method, indirect)) return nullptr;
  std::optional<RadiositySolution> loaded;
  if (!solution.empty())
    loaded = load_radiosity(scene, read_file_bytes(solution), solution, nullptr, threads);
  warn_of_lights_left_out(scene, is_quiet);
  if (!is_quiet && method == Method::kj92) warn_of_openings(scene, settings);
  std::unique_ptr<Preparation> made;
  {
    ProgressBar bar("radiosity", is_quiet);
    made = prepare(
        scene, method, settings, indirect, std::move(loaded), threads,
        [&](double f) { bar.update(f); }, stop);
  }
  if (made && !is_quiet)
    for (const std::string& w : radiosity_warnings(made->solution))
      fmt::print(stderr, "warning: {}\n", w);
  return made;
}

}  // namespace troffer
