// SIGINT and SIGTERM ask for a stop; a second one ends the program at once, without what is written
// half.
#pragma once

#include "base/parallel.h"

namespace troffer {

// Until install_stop_handlers() there is nothing to keep: a signal ends the program with status
// 130.
void exit_on_stop_signals();

// Installs the handlers and returns the flag that they set.
const StopFlag& install_stop_handlers();
// SIGUSR1 asks for the same: mpirun hands it on and lets the work end as it will.
void stop_on_user_signal();

}  // namespace troffer
