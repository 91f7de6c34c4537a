// Shows the progress of a long command: a bar on a terminal, lines in a pipe or a log.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace troffer {

// State of the current phase.
struct PhaseState {
  double fraction = 0;   // done, in [0,1]
  double seconds = 0;    // since it began
  double memory_mb = 0;  // peak memory of the program so far
};

// Returns one line for a terminal with `columns` columns. To fit, the bar shrinks first; then time
// left and memory are left out, then bar and label. The line never wraps.
std::string progress_bar(const std::string& label, const PhaseState& state, int columns);

// Progress of one phase on standard error.
class ProgressBar {
 public:
  // Prints nothing if is_quiet. On a terminal the bar is updated ten times a second. Elsewhere a
  // line appears after two seconds, and then every minute.
  ProgressBar(std::string label, bool is_quiet);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  void update(double fraction);

 private:
  using Clock = std::chrono::steady_clock;
  std::string label_;
  bool is_quiet_, is_terminal_;
  bool has_drawn_ = false;
  Clock::time_point start_ = Clock::now(), next_;
};

// Prints one line to standard error: the written files, the time, and the estimated error
// (relative; left out if unknown).
void tell_done(const std::vector<std::string>& files, double seconds, std::optional<double> error);

// Returns "a, b and c", safe for a terminal.
std::string listed(const std::vector<std::string>& names);

}  // namespace troffer
