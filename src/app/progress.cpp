#include "app/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/printable.h"
#include "app/process.h"

namespace troffer {

namespace {

std::string duration_text(double seconds) {
  const auto s = static_cast<long long>(std::lround(std::min(seconds, 1e9)));
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{}:{:02} min", s / 60, s % 60);
  return fmt::format("{}:{:02} h", s / 3600, s / 60 % 60);
}

// Returns an empty text while too little is done for an estimate.
std::string time_left(const PhaseState& s) {
  constexpr double least_fraction = 0.005;
  if (!(s.fraction > least_fraction)) return "";
  return duration_text(s.seconds * (1 - s.fraction) / s.fraction) + " left";
}

// Returns the number of UTF-8 characters.
int width_of(const std::string& text) {
  return int(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xc0u) != 0x80u;
  }));
}

int terminal_columns() {
  constexpr int usual = 80;
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : usual;
}

}  // namespace

std::string progress_bar(const std::string& label, const PhaseState& s, int columns) {
  constexpr int longest_bar = 32, shortest_bar = 8;
  const std::string percent = fmt::format("{:3.0f} %", 100 * s.fraction);
  const int room = columns - 1;  // a full line would wrap on some terminals
  const std::string rest[] = {fmt::format("  {:.0f} MB  {}", s.memory_mb, time_left(s)),
                              "  " + time_left(s), ""};
  for (const std::string& tail : rest) {
    const int around = width_of(label) + int(std::string(" [] ").size()) + width_of(percent + tail);
    const int cells = std::min(longest_bar, room - around);
    if (cells < shortest_bar) continue;
    const int filled = int(s.fraction * cells);
    return fmt::format("{} [{}{}] {}{}", label, std::string(size_t(filled), '#'),
                       std::string(size_t(cells - filled), '.'), percent, tail);
  }
  if (width_of(label) + 1 + width_of(percent) <= room) return label + " " + percent;
  return width_of(percent) <= room ? percent : "";
}

ProgressBar::ProgressBar(std::string label, bool is_quiet)
    : label_(std::move(label)), is_quiet_(is_quiet), is_terminal_(isatty(STDERR_FILENO) == 1) {
  next_ = start_ + (is_terminal_ ? std::chrono::milliseconds(100) : std::chrono::seconds(2));
}

ProgressBar::~ProgressBar() {
  if (has_drawn_ && is_terminal_) std::fputs("\r\033[K", stderr);
}

void ProgressBar::update(double fraction) {
  if (is_quiet_) return;
  const Clock::time_point now = Clock::now();
  if (now < next_) return;
  next_ = now + (is_terminal_ ? std::chrono::milliseconds(100) : std::chrono::seconds(60));
  has_drawn_ = true;
  const PhaseState state{std::clamp(fraction, 0.0, 1.0),
                         std::chrono::duration<double>(now - start_).count(), peak_memory_mb()};
  if (is_terminal_) {
    fmt::print(stderr, "\r\033[K{}", progress_bar(label_, state, terminal_columns()));
  } else {
    const std::string left = time_left(state);
    fmt::print(stderr, "{}: {:.0f} % after {}, {:.0f} MB{}{}\n", label_, 100 * state.fraction,
               duration_text(state.seconds), state.memory_mb, left.empty() ? "" : ", ", left);
  }
  std::fflush(stderr);
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + printable(names[i]);
  return text;
}

void tell_done(const std::vector<std::string>& files, double seconds, std::optional<double> error) {
  std::string text = files.empty() ? "done" : "wrote " + listed(files);
  text += seconds < 60 ? fmt::format(" in {:.1f} s", seconds) : " in " + duration_text(seconds);
  if (error && *error > 0 && std::isfinite(*error))
    text += fmt::format(", estimated error {:.2g} %", 100 * *error);
  fmt::print(stderr, "{}\n", text);
}

}  // namespace troffer
