// Cells that are kept for later runs, with their rows and direct light. Another view, or a later
// run, starts from it and adds what it sees beyond (docs/method/cells-appendix.md,
// "Walk-throughs"). Kept in a file (`--solution`).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "cells/cell_map.h"
#include "cells/cell_rows.h"

namespace troffer {

struct CellStore {
  std::shared_ptr<const CellMap> map;  // null: nothing is kept yet; else with its hits
  CellRows rows;
  std::vector<Rgb> direct;                    // irradiance straight from sources, per cell
  std::vector<float> direct_half_difference;  // luminance: half difference of halves of hits
  double direct_error = 0;                    // asked error of `direct`
  bool is_changed = false;                    // differs from what was loaded
};

// True if these are the first bytes of a file of cells.
bool are_cells(std::span<const uint8_t> bytes);

// Returns the bytes of a file. scene_key: identifies the scene and its lights. The store must have
// a map.
std::vector<uint8_t> save_cells(const CellStore& store, uint64_t scene_key);

// Reads the bytes of a file. The tracer must be that of the scene, and outlive the result. Throws
// InputError, naming `file`, if the bytes are damaged or not cells of this scene.
CellStore load_cells(std::span<const uint8_t> bytes, const std::string& file, uint64_t scene_key,
                     const Tracer& tracer);

}  // namespace troffer
