// Rank 0: hands out items of work one by one to free processes, works itself, and then sends the
// results to all. Used by troffer-mpi.
//
// A process that dies loses only the items it was working on. When nothing else is left, items that
// take much longer than usual are handed out again. All processes compute the same result, so the
// first answer counts. Results that all need travel along a binomial tree (tree.h), and directly to
// processes that report them missing.
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
#include "mpi/job_log.h"
#include "mpi/message_transport.h"
#include "mpi/messages.h"

namespace troffer {

// Seventeen members: the work, the processes that do it, and the messages sent to them.
class Leader final : public ProcessGroup {
 public:
  using Warn = std::function<void(const std::string&)>;

  // `post` must outlive the leader. warn: called when a process leaves, once there is work for all.
  // journal: may be null.
  Leader(Post& post, int default_threads, Warn warn, std::unique_ptr<JobLog> journal = nullptr);
  ~Leader() override;  // tells all processes that the run is over

  int rank() const override { return 0; }
  int size() const override { return size_; }
  bool share(const SharedWork& work, const StopFlag& stop) override;
  bool tell(SharedWork::Bytes& bytes, const StopFlag& stop) override;
  const StopFlag& stop_flag() const override { return stop_; }
  void watch(const StopFlag& asked) override { asked_ = &asked; }
  void leave(const std::string&) override {}
  int default_threads() const override { return usual_threads_; }

 private:
  using Clock = std::chrono::steady_clock;
  struct Item {
    bool is_done = false, is_mine = false;
    std::vector<int> holders;  // processes that were given it
    Clock::time_point leased_at;
  };
  struct Job {
    const SharedWork* work = nullptr;
    std::vector<size_t> order;
    size_t next = 0, done = 0;  // positions in `order`
    std::vector<Item> items;
    std::vector<SharedWork::Bytes> results;  // per item, if all processes need them
    double seconds = 0;                      // sum of times from lease to answer
    size_t answers = 0;
    std::deque<size_t> late;    // items that another process should have finished
    Clock::time_point late_at;  // time of the last search for late items
    bool is_broken_off = false, is_loading = false;
    Clock::time_point begun = Clock::now();
    JobRecord record;
  };
  struct Sent {
    std::vector<Post::Bytes> pieces;
    Clock::time_point at;
    std::vector<bool> repeated;  // per process
  };
  // State of each process.
  struct Others {
    explicit Others(size_t n) : entered(n, 0), early(n, 0), is_gone(n, false), last_words(n) {}
    std::vector<uint64_t> entered;  // its current job
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
  std::unique_ptr<JobLog> journal_;
  double last_end_ = 0;  // end of the last job, in thread_seconds() of the caller
  StopFlag stop_ = false;
  std::atomic<const StopFlag*> asked_ = nullptr;
  std::atomic<bool> is_ending_ = false;  // stop requested, or out of time
  std::mutex mutex_;                     // guards everything below
  std::condition_variable news_;
  uint64_t number_ = 0;  // number of the current job
  std::optional<Job> job_;
  std::deque<int> wanting_;  // one entry per requested item: the process
  Others others_;
  std::map<uint64_t, Sent> sent_;
  struct {
    bool has_stopped = false;  // all processes got the message to stop
    Clock::time_point last_alive;
  } said_;
  MessageTransport transport_;  // last: it uses all other members
};

}  // namespace troffer
