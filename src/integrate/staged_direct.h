// Light straight from sources at first surfaces by one DirectLight, and at what these show in gloss
// by another, which may be rougher: it arrives weaker, and mixed.
#pragma once

#include "integrate/direct_light.h"

namespace troffer {

class StagedDirect final : public DirectLight {
 public:
  // Of the same walked_part().
  StagedDirect(std::unique_ptr<DirectLight> first, std::unique_ptr<DirectLight> later);

  std::unique_ptr<DirectLightScratch> make_scratch() const override;
  WalkedPart walked_part() const override { return first_->walked_part(); }
  bool tells_variance() const override { return first_->tells_variance(); }
  void begin(DirectLightScratch& scratch) const override;
  void queue(WaveHits& wave, DirectLightScratch& scratch, RadianceBatch& out,
             Counters& counters) const override;
  void flush(DirectLightScratch& scratch, RadianceBatch& out, Counters& counters) const override;
  void weigh(SeenEmission& seen) const override;

 private:
  struct Scratch;
  std::unique_ptr<DirectLight> first_, later_;
};

}  // namespace troffer
