// The file of --solution: what a method prepares before the first viewing ray, kept for later runs.
// Its first bytes tell whether it holds a radiosity solution, which `troffer radiosity` has
// written, or cells, which are kept and added to by whoever uses them.
#pragma once

#include <memory>
#include <string>

#include "render/kept_cells.h"

namespace troffer {

enum class SolutionKind { none, missing, radiosity, cells };

// none: no file was asked for.
SolutionKind kind_of_solution(const std::string& path);

// What is kept for methods that take cells: that of the file, or nothing yet if there is no file;
// null where the method takes none, or no file was asked for.
std::unique_ptr<CellStore> cells_of_file(const PreparedScene& scene, Method method,
                                         Indirect indirect, const std::string& path);

// Writes them, if there is anything new; store: null where there is nothing to keep.
void keep_cells(const PreparedScene& scene, const CellStore* store, const std::string& path,
                bool is_quiet);

}  // namespace troffer
