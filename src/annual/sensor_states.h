// All states of all light paths of a calculation, and the sums over them at one sensor: with blinds
// as they are operated, and with blinds open. Used by annual.cpp.
#pragma once

#include <vector>

#include "annual/annual.h"
#include "annual/sensor_hours.h"
#include "annual/state_family.h"

namespace troffer {

// A scene in one state, with what is computed in it.
struct LitState {
  std::shared_ptr<const PreparedScene> scene;
  std::vector<CellHit> hits;  // sensors
  std::vector<ReflectedReplicate> reflected;
};

// States in order of paths.
class LitStates {
 public:
  LitStates(const std::vector<LightPath>& paths, const std::vector<MeasuringPoint>& points);

  size_t size() const { return states_.size(); }
  size_t paths() const { return first_.size() - 1; }
  LitState& operator[](size_t k) { return states_[k]; }
  const LitState& operator[](size_t k) const { return states_[k]; }
  // Returns the first state of a path; size() for the path number paths().
  size_t first_of(size_t path) const { return first_[path]; }
  std::vector<StateFamily> families() const;

 private:
  std::vector<size_t> first_;
  std::vector<LitState> states_;
};

// Sums of squares of illuminance and of its standard error.
struct ErrorSums {
  double squares = 0, errors = 0;
};

// Adds up the states of a sensor by a schedule.
class StateSums {
 public:
  StateSums(const LitStates& states, const StateSchedule& schedule);

  // Sums at one sensor, replicate by replicate.
  class Sensor {
   public:
    explicit Sensor(const StateSums& owner);
    // Adds some hours of state k. Each state and hour once.
    void add(size_t k, const RunOfHours& run);
    // Adds Σ L² ω / P² of the sources that an eye sees in state k (eye_glare.h).
    void add_glare(size_t k, const std::vector<float>& strengths);
    // Means of replicates. Adds squares to `sums`.
    HoursOfSensor means(ErrorSums& sums);
    std::vector<float> mean_open() const;
    HoursOfFigures of_replicate(size_t replicate) const;

   private:
    const StateSums& owner_;
    std::vector<float> operated_, open_, sun_;  // lx per replicate and hour
    std::vector<HoursOfState> states_;
    std::vector<float> strengths_;  // per hour; empty if the sensor is no eye
  };
  Sensor begin() const { return Sensor(*this); }

 private:
  const StateSchedule& schedule_;
  std::vector<size_t> path_of_, number_of_;  // path of each state, and its number there
};

}  // namespace troffer
