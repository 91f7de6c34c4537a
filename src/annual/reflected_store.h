// Keeps finished replicates of reflected light, so that an interrupted year goes on from there and
// several processes can share the work. A replicate of one state of one light path is one item.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "annual/light_paths.h"
#include "annual/reflected_light.h"
#include "lighting/weather_year.h"
#include "render/checkpoint.h"
#include "render/measure.h"

namespace troffer {

// Returns the key of everything that reflected light depends on. Occupancy, operation of blinds,
// thresholds and subdivision are not among it.
PictureKey reflected_key(const std::string& program, const std::vector<LightPath>& paths,
                         const std::vector<MeasuringPoint>& points, const WeatherYear& year,
                         const Compass& compass, const ReflectedOptions& options);

// Not thread-safe.
class ReflectedStore : public ReplicateKeeper {
 public:
  // Process number `part` (from 1) of `parts` computes each parts-th item.
  explicit ReflectedStore(int part = 1, int parts = 1) : part_(part), parts_(parts) {}

  // Saves items to a file at intervals and in save(). warn: as Checkpoint.
  void save_to(const std::string& file, const PictureKey& key, double interval,
               Checkpoint::Warn warn);
  // Adds the items of a file. Throws InputError if it is missing or damaged, or if it belongs to
  // another calculation.
  void read(const std::string& file, const PictureKey& key);

  // True if this process computes the item.
  bool is_own(size_t state, size_t replicate) const override {
    return (state * size_t(replicate_count) + replicate) % size_t(parts_) == size_t(part_ - 1);
  }
  // Sets all but the suns of a replicate, for so many sensors. Returns false if the item is
  // unknown. Throws InputError if it does not fit.
  bool find(size_t state, size_t replicate, size_t sensors, ReflectedReplicate& out) override;
  void keep(size_t state, size_t replicate, const ReflectedReplicate& item) override;
  // Writes the file. Returns the reason if that fails, or an empty string.
  std::string save();
  size_t size() const { return items_.size(); }

 private:
  struct Item {
    std::vector<uint8_t> bytes;
    std::string file;  // from which it was read; empty: computed here
  };
  void write();

  int part_, parts_;
  std::map<std::pair<size_t, size_t>, Item> items_;  // by state and replicate
  std::unique_ptr<Checkpoint> checkpoint_;
};

}  // namespace troffer
