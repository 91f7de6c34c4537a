#include "render/radiosity.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/error.h"

namespace troffer {

void check(const RadiosityOptions& o) {
  const auto is_size = [](float x) { return x >= 0 && std::isfinite(x); };
  if (!is_size(o.meshing.element_size))
    throw UsageError("radiosity: the element size must be a length in metres");
  if (!is_size(o.meshing.patch_size))
    throw UsageError("radiosity: the patch size must be a length in metres");
  if (o.meshing.patch_size > 0 && o.meshing.patch_size < o.meshing.element_size)
    throw UsageError("radiosity: patches cannot be smaller than elements");
  if (!(o.unshot_fraction > 0 && o.unshot_fraction <= 1))
    throw UsageError("radiosity: the unshot fraction must be above 0 and at most 1");
  if (o.stored_per_point > max_stored)
    throw UsageError(
        fmt::format("radiosity: at most {} contributions can be stored per point", max_stored));
  if (o.max_rays < 1 || !(o.tolerance > 0) || o.light_rays < 0 || !(o.light_share >= 0))
    throw UsageError("radiosity: numbers of rays and tolerances must be positive");
}

std::string lights_left_out(const Scene& scene) {
  const auto n = std::count_if(scene.lights.begin(), scene.lights.end(),
                               [](const Light& e) { return !has_surface(e.kind); });
  if (n == 0) return {};
  return fmt::format(
      "radiosity: indirect light leaves out {} light{} that {} no surface (points, spots, lights "
      "at infinity)",
      n, n == 1 ? "" : "s", n == 1 ? "has" : "have");
}

RadiosityResult preprocess(const PreparedScene& scene, const RadiosityOptions& options, int threads,
                           const ProgressCallback& progress, const StopFlag& stop) {
  check(options);
  const auto start = std::chrono::steady_clock::now();
  RadiosityResult result;
  result.solution = solve_radiosity(
      scene.scene, scene.tracer, scene.bsdf_tables, scene.primitives, options, threads,
      [&](const RadiosityProgress& p) {
        if (progress) progress(p.done);
      },
      stop);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

std::vector<uint8_t> save_radiosity(const PreparedScene& scene, const RadiositySolution& solution) {
  return save_solution(scene.scene, solution);
}

RadiositySolution load_radiosity(const PreparedScene& scene, std::span<const uint8_t> bytes,
                                 const std::string& file, const RadiosityOptions* options,
                                 int threads) {
  return load_solution(bytes, file, scene.scene, scene.tracer, scene.bsdf_tables, options, threads);
}

}  // namespace troffer
