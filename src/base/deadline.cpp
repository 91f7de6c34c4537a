#include "base/deadline.h"

namespace troffer {

Deadline::Deadline(const StopFlag& parent, Clock::time_point end)
    : parent_(parent), end_(end), watcher_([this] { watch(); }) {}

Deadline::~Deadline() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  ending_.notify_all();
  watcher_.join();
}

double Deadline::seconds_left() const {
  return std::chrono::duration<double>(end_ - Clock::now()).count();
}

void Deadline::watch() {
  constexpr std::chrono::milliseconds look_every{4};
  std::unique_lock lock(mutex_);
  while (!is_ending_) {
    if (parent_.load() || seconds_left() <= kept_back_.load()) {
      flag_ = true;
      return;
    }
    ending_.wait_for(lock, look_every);
  }
}

}  // namespace troffer
