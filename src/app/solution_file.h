// The file of --solution: preparation of a method, kept for later runs.
// Its first bytes tell its kind: a radiosity solution, written by `troffer radiosity`, or cells,
// which every run that uses them extends.
#pragma once

#include <memory>
#include <string>

#include "render/kept_cells.h"

namespace troffer {

enum class SolutionKind { none, missing, radiosity, cells };

// Returns the kind of the file. none: `path` is empty.
SolutionKind kind_of_solution(const std::string& path);

// Returns the cells of the file, or an empty store if it does not exist. Null if the method uses no
// cells, or if `path` is empty.
std::unique_ptr<CellStore> cells_of_file(const PreparedScene& scene, Method method,
                                         Indirect indirect, const std::string& path);

// Writes the cells if any are new. store: null if there is nothing to keep.
void keep_cells(const PreparedScene& scene, const CellStore* store, const std::string& path,
                bool is_quiet);

}  // namespace troffer
