// Every process but rank 0 (leader.h): requests items of work, does them and sends the results.
// Only troffer-mpi (main.cpp) makes one. It implements ProcessGroup (base/process_group.h), through
// which renderers share work.
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

// Fourteen members: the work, the messages received for it, and the state of the conversation.
class Follower final : public ProcessGroup {
 public:
  // `post` must outlive the follower. forsaken: called if rank 0 was silent for `patience` seconds;
  // it must not return. Rank 0 sends a sign of life every ten seconds.
  Follower(Post& post, int default_threads, double patience,
           std::function<void()> leader_is_silent);
  ~Follower() override;  // waits until rank 0 ends the run

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  bool share(const SharedWork& work, const StopFlag& stop) override;
  bool tell(SharedWork::Bytes& bytes, const StopFlag& stop) override;
  const StopFlag& stop_flag() const override { return stop_; }
  void watch(const StopFlag& asked) override { asked_ = &asked; }
  void leave(const std::string& why) override;
  int default_threads() const override { return usual_threads_; }

 private:
  using Clock = std::chrono::steady_clock;
  // Results of a job, in pieces.
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
  std::mutex mutex_;  // guards everything below
  std::condition_variable news_;
  uint64_t number_ = 0;  // number of the current job
  std::deque<Message> leases_;
  std::map<uint64_t, Results> results_;
  struct {
    bool is_over = false, has_halted = false, is_waiting = false;
    Clock::time_point heard_at = Clock::now(), asked_at;
  } talk_;
  MessageTransport transport_;  // last: it uses all other members
};

}  // namespace troffer
