#include "mpi/message_transport.h"

#include <chrono>

namespace troffer {

namespace {

using namespace std::chrono_literals;

// MPI can only poll. Items take milliseconds and the next ones are requested ahead, so short sleeps
// do no harm.
constexpr auto short_sleep = 100us, long_sleep = 500us;
constexpr int short_sleeps = 50;
constexpr auto patience_at_end = 5s;  // for messages to processes that may have died

}  // namespace

MessageTransport::MessageTransport(Post& post, Receive receive, Tick tick)
    : post_(post),
      receive_(std::move(receive)),
      tick_(std::move(tick)),
      thread_([this] { work(); }) {}

void MessageTransport::send(int to, Post::Bytes bytes) {
  const std::lock_guard lock(mutex_);
  waiting_.emplace_back(to, std::move(bytes));
}

void MessageTransport::end() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  if (thread_.joinable()) thread_.join();
}

bool MessageTransport::send_waiting() {
  std::vector<std::pair<int, Post::Bytes>> now;
  {
    const std::lock_guard lock(mutex_);
    now.swap(waiting_);
  }
  for (auto& [to, bytes] : now) post_.send(to, std::move(bytes));
  return !now.empty();
}

void MessageTransport::work() {
  for (int idle = 0;; ++idle) {
    while (std::optional<Message> l = post_.receive()) {
      receive_(std::move(*l));
      idle = 0;
    }
    tick_();
    if (send_waiting() || post_.is_moving()) idle = 0;
    {
      const std::lock_guard lock(mutex_);
      if (is_ending_) break;
    }
    if (idle > 0) std::this_thread::sleep_for(idle < short_sleeps ? short_sleep : long_sleep);
  }
  send_waiting();
  const auto give_up = std::chrono::steady_clock::now() + patience_at_end;
  while (post_.is_moving() && std::chrono::steady_clock::now() < give_up)
    std::this_thread::sleep_for(short_sleep);
}

}  // namespace troffer
