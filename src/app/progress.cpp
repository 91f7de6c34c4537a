#include "app/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/process.h"

namespace troffer {

namespace {

std::string duration_text(double seconds) {
  const auto s = static_cast<long long>(std::lround(std::min(seconds, 1e9)));
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{}:{:02} min", s / 60, s % 60);
  return fmt::format("{}:{:02} h", s / 3600, s / 60 % 60);
}

}  // namespace

ProgressBar::ProgressBar(std::string label, bool is_quiet)
    : label_(std::move(label)), is_shown_(!is_quiet && isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (has_drawn_) std::fputs("\r\033[K", stderr);
}

void ProgressBar::update(double fraction) {
  if (!is_shown_) return;
  const Clock::time_point now = Clock::now();
  if (now - drawn_ < std::chrono::milliseconds(100)) return;
  drawn_ = now;
  has_drawn_ = true;
  constexpr int cells = 32;
  fraction = std::clamp(fraction, 0.0, 1.0);
  const int filled = int(fraction * cells);
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const std::string left =
      fraction > 0.005 ? duration_text(elapsed * (1 - fraction) / fraction) + " left" : "";
  fmt::print(stderr, "\r\033[K{} [{}{}] {:3.0f} %  {:.0f} MB  {}", label_,
             std::string(size_t(filled), '#'), std::string(size_t(cells - filled), '.'),
             100 * fraction, peak_memory_mb(), left);
  std::fflush(stderr);
}

}  // namespace troffer
