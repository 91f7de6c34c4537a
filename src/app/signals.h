// SIGINT and SIGTERM ask for a stop; a second one ends the program at once.
#pragma once

#include "base/parallel.h"

namespace troffer {

// Installs the handlers and returns the flag that they set.
const StopFlag& install_stop_handlers();

}  // namespace troffer
