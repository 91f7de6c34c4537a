// What making cells leaves for later: cells, their rows and the light straight from sources.
// Another view, or the same at another day, goes on from it and adds what it sees beyond
// (docs/cells.md).
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
  std::shared_ptr<const CellMap> map;  // null: nothing is kept yet; with its hits otherwise
  CellRows rows;
  std::vector<Rgb> direct;                    // irradiance straight from sources, per cell
  std::vector<float> direct_half_difference;  // of two halves of the cell's hits: luminance
  double direct_error = 0;                    // the error that was asked for of that light
  bool is_changed = false;                    // since it was loaded
};

// Whether these are the first bytes of a file of cells.
bool are_cells(std::span<const uint8_t> bytes);

// The bytes of a file. scene_key: tells scenes apart. The store must have a map.
std::vector<uint8_t> save_cells(const CellStore& store, uint64_t scene_key);

// Throws InputError, naming `file`, for bytes that are no cells of this scene, or damaged. The
// tracer must be that of the scene, and outlive what comes back.
CellStore load_cells(std::span<const uint8_t> bytes, const std::string& file, uint64_t scene_key,
                     const Tracer& tracer);

}  // namespace troffer
