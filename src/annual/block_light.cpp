#include "annual/block_light.h"

#include <algorithm>

#include "base/streams.h"
#include "base/units.h"

namespace troffer {

namespace {

constexpr int samples_near = 4, samples_far = 2;  // light samples of a cell per source

}  // namespace

SourceBlock::SourceBlock(const OutsideSources& sources, std::span<const uint32_t> numbers,
                         uint64_t seed)
    : sources_(sources),
      numbers_(numbers),
      seed_(seed),
      drawn_{draw_sources(samples_near), draw_sources(samples_far)} {}

uint64_t SourceBlock::seed_of(uint32_t cell) const {
  return hash_of(seed_, uint64_t(cell), uint64_t(numbers_[0]), stream::annual_cell_light);
}

DrawnSources SourceBlock::draw_sources(int samples) const {
  const uint64_t seed =
      hash_of(seed_, uint64_t(numbers_[0]), uint64_t(samples), stream::annual_cell_light);
  return {sources_, numbers_, samples, seed};
}

SharedBlockLight::SharedBlockLight(const TransportCells& cells, const Tracer& tracer,
                                   const SourceBlock& block, const RayRegions& regions)
    : of_region_(regions.size()) {
  OpenRays rays(tracer);
  std::vector<uint32_t> met;
  for (uint32_t c = 0; c < cells.cell_count(); ++c) {
    for (const OutsideLink& w : cells.rows().outside.of(c))
      for (uint32_t i = 0; i < block.count(); ++i)
        if (const float l = block.radiance(i, w.direction) * pi_f; l > 0)
          lights_.push_back({c, i, w.weight * l, no_crossing});
    const auto send = [&](const CellHit& hit, uint32_t source, const Vec3& direction, float weight,
                          float cosine) {
      const Ray& ray = rays.add(hit, direction);
      CrossingRay& sent = sent_.emplace_back();
      sent.cell = c;
      sent.source = source;
      sent.weight = weight * cosine * cells.coat_factor(hit, cosine);
      met.clear();
      regions.find(ray, met);
      for (const uint32_t r : met) of_region_[r].push_back(uint32_t(crossing_.size()));
      crossing_number_.push_back(met.empty() ? no_crossing : uint32_t(crossing_.size()));
      if (met.empty()) return;
      crossing_.push_back(sent);
      crossing_.back().ray = ray;
    };
    block.draw(c, c < cells.near_count(), cells.hits(c), send);
    if (rays.size() >= OpenRays::enough) receive(rays);
  }
  receive(rays);
}

void SharedBlockLight::receive(OpenRays& rays) {
  rays.trace();
  for (size_t k = 0; k < sent_.size(); ++k) {
    const Rgb open = rays[k] * sent_[k].weight;
    if (!open.is_black())
      lights_.push_back({sent_[k].cell, sent_[k].source, open, crossing_number_[k]});
  }
  rays.clear();
  sent_.clear();
  crossing_number_.clear();
}

}  // namespace troffer
