#include "mpi/follower.h"

#include <algorithm>
#include <bit>

#include "mpi/job_log.h"
#include "mpi/tree.h"

namespace troffer {

namespace {

using namespace std::chrono_literals;

constexpr auto ask_interval = 3s;  // for results that have not arrived

}  // namespace

Follower::Follower(Post& post, int default_threads, double patience,
                   std::function<void()> leader_is_silent)
    : rank_(post.rank()),
      size_(post.size()),
      usual_threads_(default_threads),
      patience_(patience),
      forsaken_(std::move(leader_is_silent)),
      transport_(
          post, [this](Message&& l) { receive(std::move(l)); }, [this] { tick(); }) {}

// Waits for the end, because other processes may need this one to forward results.
Follower::~Follower() {
  {
    std::unique_lock lock(mutex_);
    news_.wait(lock, [&] { return talk_.is_over; });
  }
  transport_.end();
}

void Follower::leave(const std::string& why) {
  const std::span<const uint8_t> bytes(reinterpret_cast<const uint8_t*>(why.data()), why.size());
  transport_.send(0, message({MessageKind::left, 0, 0, 0}, bytes));
}

void Follower::receive(Message&& l) {
  const MessageHeader h = header_of(l);
  const std::lock_guard lock(mutex_);
  talk_.heard_at = Clock::now();
  switch (h.kind) {
    case MessageKind::lease:
      if (h.job == number_) leases_.push_back(std::move(l));
      break;
    case MessageKind::result:
    case MessageKind::repeat:
      on_result(l, h);
      break;
    case MessageKind::end:
      talk_.is_over = true;
      stop_ = true;
      transport_.send(0, message({MessageKind::bye, 0, 0, 0}));
      break;
    case MessageKind::stop:
      stop_ = true;
      break;
    default:
      break;
  }
  news_.notify_all();
}

void Follower::on_result(const Message& l, const MessageHeader& h) {
  if (h.kind == MessageKind::result) {
    const Post::Bytes same = std::make_shared<const std::vector<uint8_t>>(l.bytes);
    for (const int child : children_of(rank_, size_)) transport_.send(child, same);
  }
  if (h.job < number_) return;  // already received
  Results& r = results_[h.job];
  if (r.pieces.empty()) {
    r.pieces.resize(h.count);
    r.missing = h.count;
  }
  if (h.item >= r.pieces.size() || r.pieces[h.item]) return;
  r.pieces[h.item].emplace(rest_of(l).begin(), rest_of(l).end());
  --r.missing;
}

void Follower::tick() {
  const std::lock_guard lock(mutex_);
  const StopFlag* asked = asked_.load();
  if (asked != nullptr && asked->load() && !talk_.has_halted) {
    talk_.has_halted = true;
    transport_.send(0, message({MessageKind::halt, 0, 0, 0}));
  }
  const Clock::time_point now = Clock::now();
  if (talk_.is_waiting && now - talk_.asked_at > ask_interval) {
    talk_.asked_at = now;
    transport_.send(0, message({MessageKind::ask, 0, number_, 0}));
  }
  if (!talk_.is_over && std::chrono::duration<double>(now - talk_.heard_at).count() > patience_)
    forsaken_();
}

void Follower::begin(uint32_t items_wanted) {
  const std::lock_guard lock(mutex_);
  ++number_;
  leases_.clear();
  results_.erase(results_.begin(), results_.lower_bound(number_));
  talk_.asked_at = Clock::now();
  transport_.send(0, message({MessageKind::want, items_wanted, number_, 0}));
}

// Precondition: the lock is held.
bool Follower::has_results() const {
  const auto r = results_.find(number_);
  return r != results_.end() && r->second.missing == 0;
}

// Completed work counts even if the run is to end.
bool Follower::is_through() {
  const std::lock_guard lock(mutex_);
  return has_results();
}

// Waits for an item; returns nothing once the job is over.
std::optional<Message> Follower::next_lease(const StopFlag& stop) {
  std::unique_lock lock(mutex_);
  for (;;) {
    if (has_results() || stop_.load() || stop.load()) return std::nullopt;
    if (!leases_.empty()) {
      Message lease = std::move(leases_.front());
      leases_.pop_front();
      return lease;
    }
    talk_.is_waiting = true;
    news_.wait_for(lock, 100ms);
    talk_.is_waiting = false;
  }
}

// Work of one thread.
void Follower::work_on(const SharedWork& work, size_t slot, const StopFlag& stop) {
  while (const std::optional<Message> lease = next_lease(stop)) {
    MessageHeader h = header_of(*lease);
    if (work.take_brief) work.take_brief(h.item, ByteReader(rest_of(*lease)));
    const double start = thread_seconds();
    if (!work.act(h.item, slot)) return;
    h.count = std::bit_cast<uint32_t>(float(thread_seconds() - start));
    SharedWork::Bytes result;
    work.save(h.item, result);
    h.kind = MessageKind::done;
    transport_.send(0, message(h, result));
  }
}

bool Follower::share(const SharedWork& work, const StopFlag& stop) {
  const auto threads = size_t(thread_count(work.threads));
  // Requests more items than threads, so that the next ones arrive in time.
  begin(work.items > 0 ? uint32_t(threads + (threads + 1) / 2) : 0);
  parallel_for_slots(threads, int(threads),
                     [&](size_t, size_t slot) { work_on(work, slot, stop); });
  if (!is_through()) return false;
  if (!work.is_for_all) return true;
  const SharedWork::Bytes all = joined_results();
  ByteReader in(all);
  while (in.left() > 0) {
    const auto item = in.next<uint64_t>();
    const std::vector<uint8_t> bytes = next_all<uint8_t>(in);
    work.load(item, ByteReader(bytes));
  }
  return true;
}

bool Follower::tell(SharedWork::Bytes& bytes, const StopFlag& stop) {
  begin(0);
  while (next_lease(stop)) {
  }
  if (!is_through()) return false;
  bytes = joined_results();
  return true;
}

SharedWork::Bytes Follower::joined_results() {
  const std::lock_guard lock(mutex_);
  Results& r = results_[number_];
  SharedWork::Bytes all;
  for (std::optional<SharedWork::Bytes>& piece : r.pieces) {
    all.insert(all.end(), piece->begin(), piece->end());
    piece.reset();
  }
  return all;
}

}  // namespace troffer
