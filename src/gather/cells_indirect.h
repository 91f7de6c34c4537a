// Indirect light by gather rays that read cells (docs/method/cells.md). First hits of viewing rays
// read the fit of the picture's records where it holds, and trace gather rays of their own
// elsewhere.
#pragma once

#include <memory>

#include "gather/gather_records.h"
#include "transport/indirect_light.h"

namespace troffer {

class CellsIndirect final : public IndirectLight {
 public:
  // records: fits of the picture; null: there is no picture.
  CellsIndirect(std::shared_ptr<const Cells> cells, std::shared_ptr<const GatherRecords> records)
      : cells_(std::move(cells)), records_(std::move(records)) {}

  // Replaces the records; scratch memory made before is then invalid.
  void set_records(std::shared_ptr<const GatherRecords> records) { records_ = std::move(records); }

  std::unique_ptr<IndirectLightScratch> make_scratch() const override;
  void queue(WaveHits& wave, IndirectLightScratch& scratch, RadianceBatch& out,
             Counters& counters) const override;
  bool gathers_gloss() const override { return records_ != nullptr; }
  bool is_known() const override { return records_ != nullptr; }
  void know(const WaveHits& wave, RadianceBatch& out) const override;
  void begin(const SampleRequest& request, IndirectLightScratch& scratch) const override;
  void flush(IndirectLightScratch& scratch, RadianceBatch& out, Counters& counters) const override;
  // Traces one gather ray per sample.
  void gather(const SensorBatch& sensors, IndirectLightScratch& scratch, RadianceBatch& out,
              Counters& counters) const override;

 private:
  struct Scratch;

  std::shared_ptr<const Cells> cells_;
  std::shared_ptr<const GatherRecords> records_;
};

}  // namespace troffer
