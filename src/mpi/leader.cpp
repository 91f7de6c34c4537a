#include "mpi/leader.h"

#include <algorithm>
#include <bit>

#include "mpi/messages.h"
#include "mpi/tree.h"

namespace troffer {

namespace {

using namespace std::chrono_literals;

constexpr size_t piece_size = size_t(8) << 20;
constexpr auto alive_interval = 10s;
// Factor on the usual time after which an item is late, and its minimum.
constexpr double late_by = 4, least_late = 0.25;  // seconds
constexpr auto late_interval = 10ms;
constexpr double first_late = 10;   // until a first answer has arrived
constexpr auto time_for_tree = 2s;  // before a process gets results directly
constexpr auto time_for_byes = 3s;  // for processes that may have died

}  // namespace

Leader::Leader(Post& post, int default_threads, Warn warn, std::unique_ptr<JobLog> journal)
    : size_(post.size()),
      usual_threads_(default_threads),
      warn_(std::move(warn)),
      journal_(std::move(journal)),
      others_(size_t(post.size())),
      transport_(
          post, [this](Message&& l) { receive(std::move(l)); }, [this] { tick(); }) {}

Leader::~Leader() {
  JobRecord rest;
  rest.seconds_before = thread_seconds() - last_end_;
  write_down(std::move(rest), 0);
  stop_ = true;
  send_all({MessageKind::end, 0, 0, 0});
  {
    // All must know before this process exits, because unsent messages are lost with it.
    std::unique_lock lock(mutex_);
    news_.wait_for(lock, time_for_byes, [&] { return others_.byes + 1 == size_; });
  }
  transport_.end();
}

void Leader::send_all(const MessageHeader& header) {
  const Post::Bytes bytes = message(header);
  for (int r = 1; r < size_; ++r) transport_.send(r, bytes);
}

void Leader::receive(Message&& l) {
  const MessageHeader h = header_of(l);
  if (h.kind == MessageKind::done) return on_done(l, h);
  const std::lock_guard lock(mutex_);
  const auto from = size_t(l.from);
  switch (h.kind) {
    case MessageKind::want:
      others_.entered[from] = std::max(others_.entered[from], h.job);
      if (job_ && h.job == number_)
        wanting_.insert(wanting_.end(), h.count, l.from);
      else if (h.job > number_)
        others_.early[from] = h.count;
      break;
    case MessageKind::ask:
      on_ask(l.from, h.job);
      break;
    case MessageKind::left: {
      const std::span<const uint8_t> why = rest_of(l);
      others_.last_words[from].assign(why.begin(), why.end());
      others_.is_gone[from] = true;
      if (number_ > 0) warn_of_gone();
      break;
    }
    case MessageKind::halt:
      stop_ = true;
      break;
    case MessageKind::bye:
      ++others_.byes;
      break;
    default:
      break;
  }
  news_.notify_all();
}

// Takes a result; the first answer counts. Loads it without the lock, so that others keep working.
void Leader::on_done(const Message& l, const MessageHeader& h) {
  const SharedWork* work = nullptr;
  double start = 0;
  {
    const std::lock_guard lock(mutex_);
    start = thread_seconds();
    if (!job_ || h.job != number_ || h.item >= job_->items.size()) return;
    wanting_.push_back(l.from);
    Item& item = job_->items[h.item];
    if (item.is_done || item.is_mine) return;
    item.is_done = true;
    job_->seconds += std::chrono::duration<double>(Clock::now() - item.leased_at).count();
    ++job_->answers;
    job_->record.item_seconds[h.item] = std::bit_cast<float>(h.count);
    job_->record.answer_bytes += l.bytes.size();
    job_->is_loading = true;
    work = job_->work;
  }
  work->load(h.item, ByteReader(rest_of(l)));
  const std::lock_guard lock(mutex_);
  if (work->is_for_all) job_->results[h.item].assign(rest_of(l).begin(), rest_of(l).end());
  job_->is_loading = false;
  ++job_->done;
  job_->record.message_seconds += thread_seconds() - start;
  ++job_->record.messages;
  news_.notify_all();
}

// Precondition: the lock is held.
void Leader::on_ask(int from, uint64_t job) {
  const auto t = sent_.find(job);
  if (t == sent_.end() || Clock::now() - t->second.at < time_for_tree) return;
  if (t->second.repeated[size_t(from)]) return;
  t->second.repeated[size_t(from)] = true;
  const std::vector<Post::Bytes>& pieces = t->second.pieces;
  for (size_t i = 0; i < pieces.size(); ++i) {
    const MessageHeader h{MessageKind::repeat, uint32_t(pieces.size()), job, i};
    transport_.send(from, message(h, std::span(*pieces[i]).subspan(sizeof(MessageHeader))));
  }
}

void Leader::tick() {
  if (const StopFlag* asked = asked_.load(); asked != nullptr && asked->load()) stop_ = true;
  const std::lock_guard lock(mutex_);
  if (stop_.load()) is_ending_ = true;
  if (is_ending_.load() && !said_.has_stopped) {
    said_.has_stopped = true;
    send_all({MessageKind::stop, 0, 0, 0});
    news_.notify_all();
  }
  if (Clock::now() - said_.last_alive > alive_interval) {
    said_.last_alive = Clock::now();
    send_all({MessageKind::alive, 0, 0, 0});
  }
  if (job_ && !is_ending_.load()) hand_out();
}

// Precondition here and in all functions down to warn_of_gone(), except begin(): the lock is held.
void Leader::hand_out() {
  for (size_t left = wanting_.size(); left > 0; --left) {
    const int to = wanting_.front();
    const std::optional<size_t> item = next_item(to);
    wanting_.pop_front();
    if (!item) {
      wanting_.push_back(to);
      continue;
    }
    const double start = thread_seconds();
    SharedWork::Bytes brief;
    if (job_->work->brief) job_->work->brief(*item, brief);
    transport_.send(to, message({MessageKind::lease, 0, number_, *item}, brief));
    job_->record.brief_bytes += sizeof(MessageHeader) + brief.size();
    job_->record.message_seconds += thread_seconds() - start;
  }
}

// Returns the next item for a process and records the process as its holder.
std::optional<size_t> Leader::next_item(int rank) {
  if (others_.is_gone[size_t(rank)]) return std::nullopt;
  Job& j = *job_;
  std::optional<size_t> found;
  if (j.next < j.order.size())
    found = j.order[j.next++];
  else
    found = late_item(rank);
  if (!found) return found;
  Item& item = j.items[*found];
  item.holders.push_back(rank);
  item.leased_at = Clock::now();
  item.is_mine = rank == 0;
  return found;
}

// Returns an item that another process should have finished.
std::optional<size_t> Leader::late_item(int rank) {
  Job& j = *job_;
  if (j.done == j.order.size()) return std::nullopt;
  if (j.late.empty()) look_for_late();
  if (j.late.empty()) return std::nullopt;
  // A process never works twice on the same item.
  const std::vector<int>& holders = j.items[j.late.front()].holders;
  if (std::find(holders.begin(), holders.end(), rank) != holders.end()) return std::nullopt;
  const size_t found = j.late.front();
  j.late.pop_front();
  if (j.items[found].is_done || j.items[found].is_mine) return std::nullopt;
  return found;
}

void Leader::look_for_late() {
  Job& j = *job_;
  const Clock::time_point now = Clock::now();
  if (now - j.late_at < late_interval) return;
  j.late_at = now;
  const double usual =
      j.answers == 0 ? first_late : std::max(late_by * j.seconds / double(j.answers), least_late);
  for (const size_t i : j.order) {
    const Item& item = j.items[i];
    if (item.is_done || item.is_mine) continue;
    // Doubles the limit with each holder.
    const double allowed = usual * double(1 << std::min<size_t>(item.holders.size() - 1, 10));
    if (others_.is_gone[size_t(item.holders.back())] ||
        std::chrono::duration<double>(now - item.leased_at).count() > allowed)
      j.late.push_back(i);
  }
}

void Leader::begin(const SharedWork& work) {
  const std::lock_guard lock(mutex_);
  ++number_;
  job_.emplace();
  job_->work = &work;
  job_->order = work.order;
  if (!work.has_order)
    for (size_t i = 0; i < work.items; ++i) job_->order.push_back(i);
  job_->items.resize(work.items);
  if (work.is_for_all) job_->results.resize(work.items);
  job_->record.items = job_->order.size();
  job_->record.is_for_all = work.is_for_all;
  job_->record.item_seconds.resize(work.items);
  job_->record.seconds_before = thread_seconds() - last_end_;
  wanting_.clear();
  for (int r = 1; r < size_; ++r)
    if (others_.entered[size_t(r)] == number_)
      wanting_.insert(wanting_.end(), others_.early[size_t(r)], r);
  warn_of_gone();
}

// Warns of processes that left, with the reason they gave. Rank 0 has already printed messages
// common to all.
void Leader::warn_of_gone() {
  for (size_t r = 1; r < others_.last_words.size(); ++r) {
    std::string& words = others_.last_words[r];
    if (!words.empty() && warn_) warn_("process " + std::to_string(r) + " does no work: " + words);
    words.clear();
  }
}

// Work of one thread of this process. Returns false if the job was aborted.
bool Leader::work_on(size_t slot, const StopFlag& stop) {
  std::unique_lock lock(mutex_);
  for (;;) {
    Job& j = *job_;
    if (stop.load() || is_ending_.load()) j.is_broken_off = true;
    if (j.is_broken_off || j.done == j.order.size()) return !j.is_broken_off;
    const std::optional<size_t> item = next_item(0);
    if (!item) {
      news_.wait_for(lock, 2ms);
      continue;
    }
    lock.unlock();
    SharedWork::Bytes result;
    const double start = thread_seconds();
    const bool is_done = j.work->act(*item, slot);
    const auto seconds = float(thread_seconds() - start);
    if (is_done && j.work->is_for_all) j.work->save(*item, result);
    lock.lock();
    if (!is_done) {
      j.is_broken_off = true;
      continue;
    }
    j.items[*item].is_done = true;
    j.record.item_seconds[*item] = seconds;
    if (j.work->is_for_all) j.results[*item] = std::move(result);
    ++j.done;
    news_.notify_all();
  }
}

bool Leader::share(const SharedWork& work, const StopFlag& stop) {
  begin(work);
  struct Closing {  // even if an exception is thrown
    Leader& l;
    ~Closing() {
      std::unique_lock lock(l.mutex_);
      l.news_.wait(lock, [&] { return !l.job_->is_loading; });
      l.job_.reset();
    }
  };
  SharedWork::Bytes all;
  JobRecord record;
  bool is_broken_off = false;
  {
    const Closing closing{*this};
    const auto threads = size_t(thread_count(work.threads));
    parallel_for_slots(threads, int(threads), [&](size_t, size_t slot) { work_on(slot, stop); });
    const std::lock_guard lock(mutex_);
    is_broken_off = job_->is_broken_off;
    if (!is_broken_off && work.is_for_all) all = joined_results();
    job_->record.wall_seconds = std::chrono::duration<double>(Clock::now() - job_->begun).count();
    record = std::move(job_->record);
  }
  if (is_broken_off) {
    is_ending_ = true;
    return false;
  }
  publish(all);
  write_down(std::move(record), all.size());
  return true;
}

void Leader::write_down(JobRecord record, size_t sent_bytes) {
  record.sent_bytes = sent_bytes;
  if (journal_) journal_->add(record);
  last_end_ = thread_seconds();
}

bool Leader::tell(SharedWork::Bytes& bytes, const StopFlag& stop) {
  {
    const std::lock_guard lock(mutex_);
    ++number_;
    warn_of_gone();
  }
  if (stop.load() || stop_.load()) is_ending_ = true;
  if (is_ending_.load()) return false;
  JobRecord record;
  record.is_for_all = true;
  record.seconds_before = thread_seconds() - last_end_;
  publish(bytes);
  write_down(std::move(record), bytes.size());
  return true;
}

SharedWork::Bytes Leader::joined_results() {
  SharedWork::Bytes all;
  size_t size = 0;
  for (const SharedWork::Bytes& r : job_->results) size += r.size() + 16;
  all.reserve(size);
  for (size_t i = 0; i < job_->results.size(); ++i) {
    append(all, uint64_t(i));
    append_all(all, std::span<const uint8_t>(job_->results[i]));
    job_->results[i] = {};
  }
  return all;
}

// Sends results to all in pieces; each piece is forwarded as soon as it arrives.
void Leader::publish(const SharedWork::Bytes& bytes) {
  const std::lock_guard lock(mutex_);
  Sent& told = sent_[number_];
  told.at = Clock::now();
  told.repeated.resize(size_t(size_));
  const size_t count = std::max<size_t>(1, (bytes.size() + piece_size - 1) / piece_size);
  for (size_t i = 0; i < count; ++i) {
    const size_t first = i * piece_size;
    const MessageHeader h{MessageKind::result, uint32_t(count), number_, i};
    told.pieces.push_back(
        message(h, std::span(bytes).subspan(first, std::min(piece_size, bytes.size() - first))));
    for (const int child : children_of(0, size_)) transport_.send(child, told.pieces.back());
  }
  forget_sent();
}

// Forgets results that every process has: those of jobs before the earliest current one.
void Leader::forget_sent() {
  uint64_t first = number_;
  for (size_t r = 1; r < others_.entered.size(); ++r)
    if (!others_.is_gone[r]) first = std::min(first, others_.entered[r]);
  sent_.erase(sent_.begin(), sent_.lower_bound(first));
}

}  // namespace troffer
