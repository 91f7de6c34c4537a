#include "api/watched.h"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

namespace troffer {

namespace {

// Signals a waiting thread that the work has ended.
class Ending {
 public:
  void announce() {
    const std::lock_guard lock(mutex_);
    has_ended_ = true;
    changed_.notify_all();
  }
  // Waits for at most 50 ms. Returns true if the work has ended.
  bool wait() {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::milliseconds(50), [&] { return has_ended_; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool has_ended_ = false;
};

}  // namespace

void run_watched(const std::function<void(StopFlag& stop)>& work,
                 const std::function<void(StopFlag& stop)>& look) {
  StopFlag stop{false};
  Ending ending;
  std::exception_ptr of_work, of_look;
  std::thread worker([&] {
    try {
      work(stop);
    } catch (...) {
      of_work = std::current_exception();
    }
    ending.announce();
  });
  for (bool has_ended = false; !has_ended;) {
    has_ended = ending.wait();
    if (of_look) continue;
    try {
      look(stop);
    } catch (...) {
      of_look = std::current_exception();
      stop = true;
    }
  }
  worker.join();
  if (of_look) std::rethrow_exception(of_look);
  if (of_work) std::rethrow_exception(of_work);
}

}  // namespace troffer
