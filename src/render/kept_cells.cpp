#include "render/kept_cells.h"

#include "base/error.h"
#include "radiosity/solution.h"
#include "render/cell_pilot.h"
#include "render/preparation.h"

namespace troffer {

CellStore cells_of_surfaces(const PreparedScene& scene, double error, uint64_t seed, int threads,
                            const ProgressCallback& progress, const StopFlag& stop) {
  CellStore store;
  MethodSettings settings;
  settings.error = error;
  settings.threads = threads;
  CellInput input{surfaces_pilot(scene, seed), nullptr, seed, progress, stop, {}, {}, &store};
  make_integrator(scene, Method::certified, settings, nullptr, &input);
  return store;
}

std::vector<uint8_t> save_kept_cells(const PreparedScene& scene, const CellStore& store) {
  return save_cells(store, radiosity_scene_key(scene.scene));
}

CellStore load_kept_cells(const PreparedScene& scene, std::span<const uint8_t> bytes,
                          const std::string& file) {
  if (is_radiosity_solution(bytes))
    throw InputError(file, 0, 0,
                     "holds a radiosity solution, which only --method kj92 uses; the default keeps "
                     "cells (troffer radiosity --cells)");
  return load_cells(bytes, file, radiosity_scene_key(scene.scene), scene.tracer);
}

}  // namespace troffer
