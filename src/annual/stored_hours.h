// Looks up illuminances in the arrays of a stored year: all sensors in one hour, and one sensor in
// all hours. The year of `troffer view` uses it. Illuminance is in lx.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "annual/stored_eyes.h"
#include "annual/stored_year.h"

namespace troffer {

enum class StoredPart : uint8_t {
  total,
  direct,  // straight from the sun
};

// State of every window group: its number, or by_schedule.
using StoredStates = std::vector<int>;
constexpr int by_schedule = -1;

// Reads blocks of hours and keeps them, so that neighbouring hours need no file. For one thread at
// a time. Throws InputError if a file is gone or has become shorter.
class StoredHours {
 public:
  // Also reads the eyes of the folder, and throws as read_stored_eyes() does.
  explicit StoredHours(StoredYear year)
      : year_(std::move(year)), eyes_(read_stored_eyes(year_.folder, year_.hours)) {}
  const StoredYear& year() const { return year_; }
  const std::vector<StoredEye>& eyes() const { return eyes_; }

  // Throws UsageError for hours and states that do not exist.
  std::vector<float> all_sensors(size_t hour, StoredPart part, const StoredStates& states);
  // Returns one sensor's hours. Throws UsageError for sensors and states that do not exist.
  std::vector<float> all_hours(size_t sensor, StoredPart part, const StoredStates& states) const;
  // Returns the standard errors of all_hours() with all groups by schedule, total; empty: unknown.
  std::vector<float> errors(size_t sensor) const;

 private:
  using Block = std::pair<size_t, size_t>;  // array, and number of the block

  void check(const StoredStates& states) const;
  std::span<const float> column(size_t state, StoredPart part, size_t hour);

  const StoredYear year_;
  const std::vector<StoredEye> eyes_;
  std::map<Block, std::vector<float>> blocks_;  // columns of hours
  size_t kept_ = 0;                             // numbers in all blocks
};

}  // namespace troffer
