// Whether this process was started as one of several by mpirun.
#pragma once

namespace troffer {

// Where it was, and is to render, goes on as troffer-mpi, which stands beside this program, and
// does not return. Exit status where that cannot be, having said so; 0: it is alone.
int hand_over_to_mpi(int argc, char** argv);

}  // namespace troffer
