// How far a long command is: a bar on a terminal, and lines in a pipe or a log.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace troffer {

// State of a phase under way.
struct PhaseState {
  double fraction = 0;   // done, in [0,1]
  double seconds = 0;    // since it began
  double memory_mb = 0;  // the most of the program so far
};

// One line for a terminal of so many columns: the bar shrinks first, then time left and memory go,
// then bar and label, so that the line never wraps.
std::string progress_bar(const std::string& label, const PhaseState& state, int columns);

class ProgressBar {
 public:
  // Says nothing if is_quiet. Writes to standard error: on a terminal the bar, ten times a second;
  // elsewhere a line once the phase has taken two seconds, and then one a minute.
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

// Prints what a command has written, the time it took, and the estimated error (relative; nothing
// where none is known) to standard error, in one line.
void tell_done(const std::vector<std::string>& files, double seconds, std::optional<double> error);

// "a, b and c", for a terminal.
std::string listed(const std::vector<std::string>& names);

}  // namespace troffer
