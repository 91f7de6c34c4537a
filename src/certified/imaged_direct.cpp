#include "certified/imaged_direct.h"

#include "base/random.h"
#include "base/streams.h"

namespace troffer {

struct ImagedDirect::Scratch final : DirectLightScratch {
  std::unique_ptr<DirectLightScratch> straight;
  std::vector<std::unique_ptr<DirectLightScratch>> of_image;
  WaveHits wave;
};

ImagedDirect::ImagedDirect(std::unique_ptr<DirectLight> straight,
                           std::shared_ptr<const MirrorImages> images,
                           const std::vector<std::shared_ptr<const Occluders>>& occluders,
                           const CertifiedSettings& settings)
    : straight_(std::move(straight)), images_(std::move(images)) {
  for (size_t i = 0; i < images_->all().size(); ++i)
    of_image_.push_back(
        std::make_unique<const CertifiedDirect>(*images_->all()[i].scene, occluders[i], settings));
}

std::unique_ptr<DirectLightScratch> ImagedDirect::make_scratch() const {
  auto s = std::make_unique<Scratch>();
  s->straight = straight_->make_scratch();
  for (const auto& image : of_image_) s->of_image.push_back(image->make_scratch());
  return s;
}

void ImagedDirect::begin(const SampleRequest& request, DirectLightScratch& scratch) const {
  auto& s = static_cast<Scratch&>(scratch);
  straight_->begin(request, *s.straight);
  for (size_t i = 0; i < of_image_.size(); ++i) of_image_[i]->begin(request, *s.of_image[i]);
}

void ImagedDirect::queue(WaveHits& wave, DirectLightScratch& scratch, RadianceBatch& out,
                         Counters& counters) const {
  auto& s = static_cast<Scratch&>(scratch);
  straight_->queue(wave, *s.straight, out, counters);
  for (size_t m = 0; m < of_image_.size(); ++m) {
    const FlatMirror& mirror = images_->all()[m].mirror;
    s.wave.clear();
    s.wave.viewing = wave.viewing;
    for (size_t i = 0; i < wave.size(); ++i) {
      if (!wave.scatterings[i].has_diffuse) continue;
      if (mirror.above(wave.vertices[i].surface.position) <= mirror.tolerance) continue;
      Walk walk = wave.walks[i];
      // Light from a mirror has been reflected once, so it counts as indirect and uses its own
      // random numbers.
      ++walk.scatterings;
      ++walk.vertex;
      walk.stream = hash_of(walk.stream, stream::mirror_image_of_hit, uint64_t(m));
      s.wave.walks.push_back(walk);
      s.wave.vertices.push_back(wave.vertices[i]);
      const SurfaceScattering& scattering = wave.scatterings[i];
      if (scattering.is_gathered)
        s.wave.scatterings.emplace_back(scattering.whole).gather_gloss();
      else
        s.wave.scatterings.emplace_back(scattering.diffuse);
    }
    if (s.wave.size() > 0) of_image_[m]->queue(s.wave, *s.of_image[m], out, counters);
  }
}

void ImagedDirect::flush(DirectLightScratch& scratch, RadianceBatch& out,
                         Counters& counters) const {
  auto& s = static_cast<Scratch&>(scratch);
  straight_->flush(*s.straight, out, counters);
  for (size_t i = 0; i < of_image_.size(); ++i) of_image_[i]->flush(*s.of_image[i], out, counters);
}

}  // namespace troffer
