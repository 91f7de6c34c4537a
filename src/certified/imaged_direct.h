// Direct light by one DirectLight, plus light that reaches diffuse surfaces by way of flat mirrors.
// The latter is computed by certified visibility in each mirror's reflected scene, and counts as
// indirect light.
//
// make_direct() in methods/certified_method.cpp wraps the direct light in this class where the
// scene has flat mirrors.
#pragma once

#include "certified/certified_direct.h"
#include "transport/mirror_images.h"

namespace troffer {

class ImagedDirect final : public DirectLight {
 public:
  // occluders: one per mirror image.
  ImagedDirect(std::unique_ptr<DirectLight> straight, std::shared_ptr<const MirrorImages> images,
               const std::vector<std::shared_ptr<const Occluders>>& occluders,
               const CertifiedSettings& settings);

  std::unique_ptr<DirectLightScratch> make_scratch() const override;
  WalkedPart walked_part() const override { return straight_->walked_part(); }
  bool estimates_variance() const override { return straight_->estimates_variance(); }
  std::shared_ptr<const MirrorImages> images() const override { return images_; }
  void begin(const SampleRequest& request, DirectLightScratch& scratch) const override;
  void queue(WaveHits& wave, DirectLightScratch& scratch, RadianceBatch& out,
             Counters& counters) const override;
  void flush(DirectLightScratch& scratch, RadianceBatch& out, Counters& counters) const override;
  // Walks that glossy lobes send into mirrors count what they meet there themselves.
  void weigh(SeenEmission& seen) const override { straight_->weigh(seen); }

 private:
  struct Scratch;

  std::unique_ptr<DirectLight> straight_;
  std::shared_ptr<const MirrorImages> images_;
  std::vector<std::unique_ptr<const CertifiedDirect>> of_image_;
};

}  // namespace troffer
