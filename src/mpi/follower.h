// All processes but rank 0 (leader.h): asks for items of work, does them, sends what came of them.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/process_group.h"
#include "mpi/message_transport.h"
#include "mpi/messages.h"

namespace troffer {

// Fourteen members: the work, what has come for it, and what was said.
class Follower final : public ProcessGroup {
 public:
  // The post must outlive this. forsaken: called once rank 0 has been silent for `patience` seconds
  // (it says every ten that it is there); must not return.
  Follower(Post& post, int usual_threads, double patience, std::function<void()> forsaken);
  ~Follower() override;  // waits until rank 0 says that it is over

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  bool share(const SharedWork& work, const StopFlag& stop) override;
  bool tell(SharedWork::Bytes& bytes, const StopFlag& stop) override;
  const StopFlag& stop_flag() const override { return stop_; }
  void watch(const StopFlag& asked) override { asked_ = &asked; }
  void leave(const std::string& why) override;
  int usual_threads() const override { return usual_threads_; }

 private:
  using Clock = std::chrono::steady_clock;
  // What a job has come to.
  struct Results {
    std::vector<std::optional<SharedWork::Bytes>> pieces;
    size_t missing = 1;
  };

  void receive(Message&& l);
  void on_result(const Message& l, const MessageHeader& h);
  void tick();
  void begin(uint32_t items_wanted);
  bool has_results() const;
  bool is_through();
  std::optional<Message> next_lease(const StopFlag& stop);
  void work_on(const SharedWork& work, size_t slot, const StopFlag& stop);
  SharedWork::Bytes joined_results();

  const int rank_, size_, usual_threads_;
  const double patience_;
  std::function<void()> forsaken_;
  StopFlag stop_ = false;
  std::atomic<const StopFlag*> asked_ = nullptr;
  std::mutex mutex_;  // of all below
  std::condition_variable news_;
  uint64_t number_ = 0;  // of the job
  std::deque<Message> leases_;
  std::map<uint64_t, Results> results_;
  struct {
    bool is_over = false, has_halted = false, is_waiting = false;
    Clock::time_point heard_at = Clock::now(), asked_at;
  } talk_;
  MessageTransport transport_;  // last: it uses all the others
};

}  // namespace troffer
