// The files that a command writes.
#pragma once

#include <string>
#include <vector>

#include "image/atomic_file.h"

namespace troffer {

// Makes sure, before long work, that all of them and `stats`, if there is one, can be written; kept
// until they are.
std::vector<OutputReservation> reserve_outputs(const std::vector<std::string>& outputs,
                                               const std::string& stats);

}  // namespace troffer
