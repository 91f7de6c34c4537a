// Detects whether mpirun started this process as one of several. main() calls it.
#pragma once

namespace troffer {

// Replaces this process by troffer-mpi, from the same folder, if it is one of several and is to
// render; then it does not return. Returns 0 if the process is alone, or an exit status after
// reporting a failure.
int hand_over_to_mpi(int argc, char** argv);

}  // namespace troffer
