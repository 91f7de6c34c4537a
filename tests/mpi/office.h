// Threads that act as processes, and messages between them: Leader and Follower without MPI.
#pragma once

#include <atomic>
#include <chrono>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "mpi/follower.h"
#include "mpi/leader.h"
#include "mpi/post.h"

namespace troffer::test {

class Office {
 public:
  explicit Office(int size) : boxes_(size_t(size)), is_dead_(size_t(size), false) {}
  int size() const { return int(boxes_.size()); }
  // From now on, messages from and to this process are lost.
  void kill(int rank) {
    const std::lock_guard lock(mutex_);
    is_dead_[size_t(rank)] = true;
    // Ends its threads, too.
    boxes_[size_t(rank)] = {{0, *message({MessageKind::end, 0, 0, 0})}};
  }
  void put(int from, int to, const Post::Bytes& bytes) {
    const std::lock_guard lock(mutex_);
    if (!is_dead_[size_t(from)] && !is_dead_[size_t(to)])
      boxes_[size_t(to)].push_back({from, *bytes});
  }
  std::optional<Message> take(int rank) {
    const std::lock_guard lock(mutex_);
    std::deque<Message>& box = boxes_[size_t(rank)];
    if (box.empty()) return std::nullopt;
    Message l = std::move(box.front());
    box.pop_front();
    return l;
  }

 private:
  std::mutex mutex_;
  std::vector<std::deque<Message>> boxes_;
  std::vector<bool> is_dead_;
};

class OfficePost final : public Post {
 public:
  OfficePost(Office& office, int rank) : office_(office), rank_(rank) {}
  int rank() const override { return rank_; }
  int size() const override { return office_.size(); }
  std::optional<Message> receive() override { return office_.take(rank_); }
  void send(int to, Bytes bytes) override { office_.put(rank_, to, bytes); }
  bool is_moving() override { return false; }

 private:
  Office& office_;
  int rank_;
};

// Runs body(group) as each process. Rank 0 runs in this thread, which waits for all.
template <class Body>
void run_group(Office& office, const Leader::Warn& warn, const Body& body) {
  std::vector<std::thread> others;
  std::atomic<int> at_work = office.size() - 1;
  for (int r = 1; r < office.size(); ++r)
    others.emplace_back([&, r] {
      OfficePost post(office, r);
      Follower group(post, 1, 1e9, [] {});
      body(group);
      --at_work;
    });
  {
    OfficePost post(office, 0);
    Leader group(post, 1, warn);
    body(group);
    while (at_work > 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  for (std::thread& t : others) t.join();
}

}  // namespace troffer::test
