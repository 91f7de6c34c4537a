// Direct light by two DirectLights. `first` lights the first surfaces of a pixel's first samples.
// `later` lights what these surfaces reflect, and all of a pixel's further samples. It may be less
// accurate, because its light is attenuated and averaged.
#pragma once

#include "transport/direct_light.h"

namespace troffer {

class StagedDirect final : public DirectLight {
 public:
  // Both must have the same walked_part(). samples: number of first samples of a pixel.
  StagedDirect(std::unique_ptr<DirectLight> first, std::unique_ptr<DirectLight> later,
               uint32_t samples);

  std::unique_ptr<DirectLightScratch> make_scratch() const override;
  WalkedPart walked_part() const override { return first_->walked_part(); }
  bool estimates_variance() const override { return first_->estimates_variance(); }
  void begin(const SampleRequest& request, DirectLightScratch& scratch) const override;
  void queue(WaveHits& wave, DirectLightScratch& scratch, RadianceBatch& out,
             Counters& counters) const override;
  void flush(DirectLightScratch& scratch, RadianceBatch& out, Counters& counters) const override;
  void weigh(SeenEmission& seen) const override;

 private:
  struct Scratch;
  bool is_first(const Walk& walk, uint32_t scatterings) const {
    return walk.scatterings <= scatterings && walk.sample < samples_;
  }
  void take(const WaveHits& wave, bool first, WaveHits& out) const;

  std::unique_ptr<DirectLight> first_, later_;
  uint32_t samples_;
};

}  // namespace troffer
