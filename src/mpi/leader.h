// Rank 0: hands out items of work, one by one, to whoever is free, and takes part itself; then
// tells all what came of them.
//
// Whoever dies costs no more than what it had under way: when nothing else is left to hand out,
// items that take much longer than others are handed out again. All come to the same, so the first
// answer counts. What all are to know goes from process to process along a binomial tree, and
// directly to those who ask because it has not come.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/process_group.h"
#include "mpi/journal.h"
#include "mpi/message_transport.h"
#include "mpi/messages.h"

namespace troffer {

// Seventeen members: the work, those who do it, and what was said to them.
class Leader final : public ProcessGroup {
 public:
  using Warn = std::function<void(const std::string&)>;

  // The post must outlive this. warn: that somebody left; once there is work for all.
  // journal: may be null.
  Leader(Post& post, int usual_threads, Warn warn, std::unique_ptr<Journal> journal = nullptr);
  ~Leader() override;  // tells all that it is over

  int rank() const override { return 0; }
  int size() const override { return size_; }
  bool share(const SharedWork& work, const StopFlag& stop) override;
  bool tell(SharedWork::Bytes& bytes, const StopFlag& stop) override;
  const StopFlag& stop_flag() const override { return stop_; }
  void watch(const StopFlag& asked) override { asked_ = &asked; }
  void leave(const std::string&) override {}
  int usual_threads() const override { return usual_threads_; }

 private:
  using Clock = std::chrono::steady_clock;
  struct Item {
    bool is_done = false, is_mine = false;
    std::vector<int> holders;  // processes that have been given it
    Clock::time_point leased_at;
  };
  struct Job {
    const SharedWork* work = nullptr;
    std::vector<size_t> order;
    size_t next = 0, done = 0;  // of the order
    std::vector<Item> items;
    std::vector<SharedWork::Bytes> results;  // of items, where all are to know
    double seconds = 0;                      // from leases to answers
    size_t answers = 0;
    std::deque<size_t> late;    // items that somebody else should have done by now
    Clock::time_point late_at;  // when that was last looked at
    bool is_broken_off = false, is_loading = false;
    Clock::time_point begun = Clock::now();
    JobRecord record;
  };
  struct Sent {
    std::vector<Post::Bytes> pieces;
    Clock::time_point at;
    std::vector<bool> repeated;  // to each process
  };
  // What is known of each process.
  struct Others {
    explicit Others(size_t n) : entered(n, 0), early(n, 0), is_gone(n, false), last_words(n) {}
    std::vector<uint64_t> entered;  // the job it is at
    std::vector<uint32_t> early;    // items wanted of a job that has not begun
    std::vector<bool> is_gone;
    std::vector<std::string> last_words;
    int byes = 0;
  };

  void receive(Message&& l);
  void on_done(const Message& l, const MessageHeader& h);
  void on_ask(int from, uint64_t job);
  void tick();
  void hand_out();
  void warn_of_gone();
  std::optional<size_t> next_item(int rank);
  std::optional<size_t> late_item(int rank);
  void look_for_late();
  void begin(const SharedWork& work);
  bool work_on(size_t slot, const StopFlag& stop);
  void publish(const SharedWork::Bytes& bytes);
  void write_down(JobRecord record, size_t sent_bytes);
  SharedWork::Bytes joined_results();
  void forget_sent();
  void send_all(const MessageHeader& header);

  const int size_, usual_threads_;
  Warn warn_;
  std::unique_ptr<Journal> journal_;
  double last_end_ = 0;  // of a job: thread_seconds() of who calls for work
  StopFlag stop_ = false;
  std::atomic<const StopFlag*> asked_ = nullptr;
  std::atomic<bool> is_ending_ = false;  // for that, or because time is over
  std::mutex mutex_;                     // of all below
  std::condition_variable news_;
  uint64_t number_ = 0;  // of the job
  std::optional<Job> job_;
  std::deque<int> wanting_;  // a process for each item that it wants
  Others others_;
  std::map<uint64_t, Sent> sent_;
  struct {
    bool has_stopped = false;  // all were told to
    Clock::time_point last_alive;
  } said_;
  MessageTransport transport_;  // last: it uses all the others
};

}  // namespace troffer
