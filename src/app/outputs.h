// Reserves the files that a command writes, before its long work.
#pragma once

#include <string>
#include <vector>

#include "image/atomic_file.h"
#include "render/preparation.h"

namespace troffer {

// Makes sure that all outputs and `stats`, if not empty, can be written. Keep the result until they
// are.
std::vector<OutputReservation> reserve_outputs(const std::vector<std::string>& outputs,
                                               const std::string& stats);

// Reserves the file of cells if the method keeps cells and `path` is not empty.
void reserve_cells(const std::string& path, const Method& method, Indirect indirect,
                   std::vector<OutputReservation>& reserved);

}  // namespace troffer
