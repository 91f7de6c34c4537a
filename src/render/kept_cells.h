// Cells that a view leaves for the next (cells/cell_store.h), as bytes: the façade.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "cells/cell_store.h"
#include "methods/methods.h"
#include "render/progress.h"
#include "transport/prepared_scene.h"

namespace troffer {

// Cells for all of the scene, from wherever it will be seen; `error`, of render, bounds that of
// their direct light. Empty once `stop` is set.
CellStore cells_of_surfaces(const PreparedScene& scene, double error, uint64_t seed, int threads,
                            const ProgressCallback& progress, const StopFlag& stop);

std::vector<uint8_t> save_kept_cells(const PreparedScene& scene, const CellStore& store);

// Throws InputError, naming `file`, for bytes that are no cells of this scene, or damaged.
CellStore load_kept_cells(const PreparedScene& scene, std::span<const uint8_t> bytes,
                          const std::string& file);

}  // namespace troffer
