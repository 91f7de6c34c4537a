// The files that a command writes.
#pragma once

#include <string>
#include <vector>

#include "image/atomic_file.h"
#include "render/preparation.h"

namespace troffer {

// Makes sure, before long work, that all of them and `stats`, if there is one, can be written; kept
// until they are.
std::vector<OutputReservation> reserve_outputs(const std::vector<std::string>& outputs,
                                               const std::string& stats);

// The same for a file of cells, where the method keeps cells and the user has named one.
void reserve_cells(const std::string& path, const Method& method, Indirect indirect,
                   std::vector<OutputReservation>& reserved);

}  // namespace troffer
