// A progress bar with the most memory so far and the time left, on a terminal; nothing elsewhere.
#pragma once

#include <chrono>
#include <string>

namespace troffer {

class ProgressBar {
 public:
  // Draws to standard error if it is a terminal and not `is_quiet`.
  ProgressBar(std::string label, bool is_quiet);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  // fraction in [0,1]; redraws ten times a second at most.
  void update(double fraction);

 private:
  using Clock = std::chrono::steady_clock;
  std::string label_;
  bool is_shown_;
  bool has_drawn_ = false;
  Clock::time_point start_ = Clock::now(), drawn_ = start_;
};

}  // namespace troffer
