// Runs work on a separate thread while the caller's thread reports progress and may stop it.
// render() and measure() of the public interface use it.
#pragma once

#include <functional>

#include "base/parallel.h"

namespace troffer {

// Runs work(stop) on a separate thread. Meanwhile the calling thread calls look(stop) twenty times
// a second, and once more at the end. If look() throws, sets `stop` and rethrows after the work has
// ended; otherwise rethrows what the work threw. The work must obey the flag.
void run_watched(const std::function<void(StopFlag& stop)>& work,
                 const std::function<void(StopFlag& stop)>& look);

}  // namespace troffer
