// Work on a thread of its own while the caller's thread reports progress and may stop it. Used by
// api/ for pictures and measurements.
#pragma once

#include <functional>

#include "base/parallel.h"

namespace troffer {

// Runs work(stop) on a thread of its own while the calling thread calls look() twenty times a
// second, and once more at the end. What look() throws sets `stop` and is thrown after the work has
// ended; otherwise what the work throws. The work must obey the flag.
void run_watched(const std::function<void(StopFlag& stop)>& work,
                 const std::function<void(StopFlag& stop)>& look);

}  // namespace troffer
