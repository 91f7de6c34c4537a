// Time and memory of this process, for statistics and progress.
#pragma once

#include <chrono>

namespace troffer {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point t);
// Returns the processor time of all threads so far, s.
double cpu_seconds();
// Returns the peak resident memory, MiB.
double peak_memory_mb();

}  // namespace troffer
