// Cells that one view leaves for the next (cells/cell_store.h), and their form as bytes. Used by
// the solution file (app/solution_file.h).
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

// Computes cells for the whole scene, for any later view. `error` is the relative error asked for;
// it bounds the error of the cells' direct light. Returns an empty store once `stop` is set.
CellStore cells_of_surfaces(const PreparedScene& scene, double error, uint64_t seed, int threads,
                            const ProgressCallback& progress, const StopFlag& stop);

// Returns the store as bytes, with a key of the scene.
std::vector<uint8_t> save_kept_cells(const PreparedScene& scene, const CellStore& store);

// Returns the store from such bytes. Throws InputError, naming `file`, if they are damaged or
// belong to another scene.
CellStore load_kept_cells(const PreparedScene& scene, std::span<const uint8_t> bytes,
                          const std::string& file);

}  // namespace troffer
