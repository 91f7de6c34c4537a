#include "app/commands.h"
#include "app/progress.h"
#include "base/error.h"
#include "image/read_image.h"
#include "render/radiosity.h"

namespace troffer {

void check_method(Method method, Indirect indirect, const std::string& solution) {
  if (method == Method::kj92) return;
  if (indirect == Indirect::radiosity)
    throw UsageError("--indirect radiosity belongs to --method kj92");
  if (!solution.empty()) throw UsageError("--solution belongs to --method kj92");
}

std::unique_ptr<Kj92Preparation> prepare_method(const PreparedScene& scene, Method method,
                                                const Kj92Settings& settings, Indirect indirect,
                                                const std::string& solution, int threads,
                                                bool is_quiet, const StopFlag& stop) {
  if (method != Method::kj92) return nullptr;
  std::optional<RadiositySolution> loaded;
  if (!solution.empty())
    loaded = load_radiosity(scene, read_file_bytes(solution), solution, nullptr, threads);
  ProgressBar bar("radiosity", is_quiet);
  return prepare_kj92(
      scene, settings, indirect == Indirect::none, std::move(loaded), threads,
      [&](double f) { bar.update(f); }, stop);
}

}  // namespace troffer
