// Measures points that users pick, in the background, one list after the other.
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

struct MeasuringTask {
  std::shared_ptr<Lighting> lighting;
  std::vector<MeasuringPoint> points;
  bool by_dimmers = false;  // by each dimmer alone; else by all light together
};

struct MeasuringAnswer {
  MeasuringTask task;
  // [dimmer][point]; one row where the task is by all light together. Illuminance of all light by
  // settings d of the dimmers is Σ d E, its standard error the root of Σ (d σ)².
  std::vector<std::vector<Measurement>> values;
  bool is_done = false;
  std::string failure;
};

constexpr size_t most_measuring_points = 10'000;

class MeasuringQueue {
 public:
  explicit MeasuringQueue(const MeasureOptions& options);
  ~MeasuringQueue();
  MeasuringQueue(const MeasuringQueue&) = delete;
  MeasuringQueue& operator=(const MeasuringQueue&) = delete;

  // The number of the task. UsageError for more points, or more tasks at a time, than there may be.
  uint64_t add(const MeasuringTask& task);
  // Nothing of numbers that were never given or are long past.
  std::optional<MeasuringAnswer> answer(uint64_t number) const;

 private:
  // Cells, and the scene that they belong to.
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
  std::map<size_t, Kept> kept_;  // by dimmers; whole: their number
  std::thread thread_;           // last: it uses all the others
};

}  // namespace troffer
