#include "certified/staged_direct.h"

#include <algorithm>

#include "base/error.h"

namespace troffer {

struct StagedDirect::Scratch final : DirectLightScratch {
  std::unique_ptr<DirectLightScratch> first, later;
  WaveHits part;
};

StagedDirect::StagedDirect(std::unique_ptr<DirectLight> first, std::unique_ptr<DirectLight> later,
                           uint32_t samples)
    : first_(std::move(first)), later_(std::move(later)), samples_(samples) {
  TROFFER_CHECK(first_->walked_part() == later_->walked_part());
}

// Copies to `out` the hits of `wave` that first_ lights, or those that later_ lights.
void StagedDirect::take(const WaveHits& wave, bool first, WaveHits& out) const {
  out.clear();
  out.viewing = wave.viewing;
  for (size_t i = 0; i < wave.size(); ++i) {
    if (is_first(wave.walks[i], 0) == first) out.take(wave, i);
  }
}

std::unique_ptr<DirectLightScratch> StagedDirect::make_scratch() const {
  auto s = std::make_unique<Scratch>();
  s->first = first_->make_scratch();
  s->later = later_->make_scratch();
  return s;
}

void StagedDirect::begin(const SampleRequest& request, DirectLightScratch& scratch) const {
  auto& s = static_cast<Scratch&>(scratch);
  first_->begin(request, *s.first);
  later_->begin(request, *s.later);
}

void StagedDirect::queue(WaveHits& wave, DirectLightScratch& scratch, RadianceBatch& out,
                         Counters& counters) const {
  auto& s = static_cast<Scratch&>(scratch);
  const auto firsts = size_t(std::count_if(wave.walks.begin(), wave.walks.end(),
                                           [&](const Walk& w) { return is_first(w, 0); }));
  if (firsts == wave.size()) return first_->queue(wave, *s.first, out, counters);
  if (firsts == 0) return later_->queue(wave, *s.later, out, counters);
  take(wave, true, s.part);
  first_->queue(s.part, *s.first, out, counters);
  take(wave, false, s.part);
  later_->queue(s.part, *s.later, out, counters);
}

void StagedDirect::flush(DirectLightScratch& scratch, RadianceBatch& out,
                         Counters& counters) const {
  auto& s = static_cast<Scratch&>(scratch);
  first_->flush(*s.first, out, counters);
  later_->flush(*s.later, out, counters);
}

// Emission that a walk hit is weighted by the DirectLight that lit the walk's previous vertex.
void StagedDirect::weigh(SeenEmission& seen) const {
  if (std::all_of(seen.walks.begin(), seen.walks.end(),
                  [&](const Walk* w) { return is_first(*w, 1); }))
    return first_->weigh(seen);
  for (const bool first : {true, false}) {
    SeenEmission part;
    std::vector<size_t> places;
    for (size_t i = 0; i < seen.size(); ++i) {
      if (is_first(*seen.walks[i], 1) != first) continue;
      part.add(*seen.walks[i], seen.vertices[i], seen.radiance[i], seen.at_infinity[i]);
      places.push_back(i);
    }
    if (places.empty()) continue;
    (first ? first_ : later_)->weigh(part);
    for (size_t k = 0; k < places.size(); ++k) seen.weights[places[k]] = part.weights[k];
  }
}

}  // namespace troffer
