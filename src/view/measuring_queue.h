// Measures points that users pick, in the background, one list after the other.
// ViewService adds tasks and asks for their answers. Illuminance is in lx.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "render/measure.h"
#include "view/dimmers.h"

namespace troffer {

// Points to measure in a scene.
struct MeasuringTask {
  std::shared_ptr<Lighting> lighting;
  std::vector<MeasuringPoint> points;
  bool by_dimmers = false;  // true: under each dimmer alone; false: under all light
};

// State and result of a task.
struct MeasuringAnswer {
  MeasuringTask task;
  // Values as [dimmer][point]; a single row if measured under all light. With dimmer settings d the
  // illuminance is Σ d E, and its standard error is the root of Σ (d σ)².
  std::vector<std::vector<Measurement>> values;
  bool is_done = false;
  std::string failure;
};

constexpr size_t most_measuring_points = 10'000;

// Runs tasks in order on a thread of its own. Thread-safe.
class MeasuringQueue {
 public:
  explicit MeasuringQueue(const MeasureOptions& options);
  ~MeasuringQueue();
  MeasuringQueue(const MeasuringQueue&) = delete;
  MeasuringQueue& operator=(const MeasuringQueue&) = delete;

  // Queues a task and returns its number. Throws UsageError if it has too many points, or if too
  // many tasks are waiting.
  uint64_t add(const MeasuringTask& task);
  // Returns the answer of a task; empty if the number is unknown or its answer has been discarded.
  std::optional<MeasuringAnswer> answer(uint64_t number) const;

 private:
  // Cells of one light, and the scene they belong to.
  struct Kept {
    std::shared_ptr<const PreparedScene> scene;
    CellStore cells;
  };
  void run();
  std::vector<std::vector<Measurement>> values_of(const MeasuringTask& task);

  const MeasureOptions options_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::map<uint64_t, MeasuringAnswer> answers_;
  std::deque<uint64_t> waiting_;
  uint64_t last_ = 0;
  bool is_ending_ = false;
  StopFlag stop_ = false;
  std::map<size_t, Kept> kept_;  // by dimmer; key for all light: number of dimmers
  std::thread thread_;           // last member: its thread uses all others
};

}  // namespace troffer
