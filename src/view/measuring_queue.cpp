#include "view/measuring_queue.h"

#include "base/error.h"

namespace troffer {

namespace {

constexpr size_t most_answers = 256, most_waiting = 64;

}  // namespace

MeasuringQueue::MeasuringQueue(const MeasureOptions& options)
    : options_(options), thread_([this] { run(); }) {}

MeasuringQueue::~MeasuringQueue() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

uint64_t MeasuringQueue::add(const MeasuringTask& task) {
  if (task.points.empty() || task.points.size() > most_measuring_points)
    throw UsageError("between 1 and " + std::to_string(most_measuring_points) +
                     " points can be measured at a time");
  const std::lock_guard lock(mutex_);
  if (waiting_.size() >= most_waiting) throw UsageError("too many points wait to be measured");
  answers_[++last_].task = task;
  waiting_.push_back(last_);
  while (answers_.size() > most_answers) answers_.erase(answers_.begin());
  changed_.notify_all();
  return last_;
}

std::optional<MeasuringAnswer> MeasuringQueue::answer(uint64_t number) const {
  const std::lock_guard lock(mutex_);
  const auto at = answers_.find(number);
  if (at == answers_.end()) return std::nullopt;
  return at->second;
}

void MeasuringQueue::run() {
  for (;;) {
    uint64_t number = 0;
    MeasuringTask task;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return is_ending_ || !waiting_.empty(); });
      if (is_ending_) return;
      number = waiting_.front();
      waiting_.pop_front();
      task = answers_[number].task;
    }
    std::vector<std::vector<Measurement>> values;
    std::string failure;
    try {
      values = values_of(task);
    } catch (const std::exception& e) {  // out of memory
      failure = e.what();
    }
    const std::lock_guard lock(mutex_);
    const auto at = answers_.find(number);
    if (is_ending_ || at == answers_.end()) continue;
    at->second.values = std::move(values);
    at->second.failure = failure;
    at->second.is_done = true;
  }
}

std::vector<std::vector<Measurement>> MeasuringQueue::values_of(const MeasuringTask& task) {
  const size_t count = task.lighting->dimmers().size();
  const bool is_whole = !task.by_dimmers || count < 2;
  std::vector<std::vector<Measurement>> values;
  for (size_t i = is_whole ? count : 0; i < (is_whole ? count + 1 : count); ++i) {
    Kept& k = kept_[i];
    const auto scene = is_whole ? task.lighting->whole() : task.lighting->dimmer(i);
    if (k.scene != scene) k = {scene, {}};
    MeasureOptions o = options_;
    CellStore cells = k.cells;  // a stopped run leaves no cells
    o.cells = &cells;
    const MeasureResult result = measure(*scene, task.points, o, nullptr, stop_);
    if (!result.is_complete) break;
    k.cells = std::move(cells);
    values.push_back(result.values);
  }
  return values;
}

}  // namespace troffer
