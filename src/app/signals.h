// SIGINT and SIGTERM ask for a stop. A second signal ends the program at once and removes
// half-written files.
#pragma once

#include "base/parallel.h"

namespace troffer {

// Makes signals end the program with status 130. Use it until install_stop_handlers(), while there
// is no work to keep.
void exit_on_stop_signals();

// Installs the handlers and returns the flag that they set.
const StopFlag& install_stop_handlers();
// Makes SIGUSR1 a request to stop, too: mpirun forwards it and waits for the work to end.
void stop_on_user_signal();

}  // namespace troffer
