// Light straight from sources by one DirectLight, and what their images in flat mirrors send to the
// diffuse parts of surfaces, by certified visibility in each mirror's own scene. The latter counts
// as reflected light.
#pragma once

#include "certified/certified_direct.h"
#include "transport/mirror_images.h"

namespace troffer {

class ImagedDirect final : public DirectLight {
 public:
  // occluders: of each image.
  ImagedDirect(std::unique_ptr<DirectLight> straight, std::shared_ptr<const MirrorImages> images,
               const std::vector<std::shared_ptr<const Occluders>>& occluders,
               const CertifiedSettings& settings);

  std::unique_ptr<DirectLightScratch> make_scratch() const override;
  WalkedPart walked_part() const override { return straight_->walked_part(); }
  bool tells_variance() const override { return straight_->tells_variance(); }
  std::shared_ptr<const MirrorImages> images() const override { return images_; }
  void begin(const SampleRequest& request, DirectLightScratch& scratch) const override;
  void queue(WaveHits& wave, DirectLightScratch& scratch, RadianceBatch& out,
             Counters& counters) const override;
  void flush(DirectLightScratch& scratch, RadianceBatch& out, Counters& counters) const override;
  // What walks find in mirrors that gloss sent them to is theirs.
  void weigh(SeenEmission& seen) const override { straight_->weigh(seen); }

 private:
  struct Scratch;

  std::unique_ptr<DirectLight> straight_;
  std::shared_ptr<const MirrorImages> images_;
  std::vector<std::unique_ptr<const CertifiedDirect>> of_image_;
};

}  // namespace troffer
