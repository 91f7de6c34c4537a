// Time and memory of this process, for statistics.
#pragma once

#include <chrono>

namespace troffer {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point t);
// Processor time of all threads so far.
double cpu_seconds();
// The most that was ever resident, MiB.
double peak_memory_mb();

}  // namespace troffer
