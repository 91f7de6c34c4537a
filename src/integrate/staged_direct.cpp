#include "integrate/staged_direct.h"

#include <algorithm>

#include "base/error.h"

namespace troffer {

namespace {

// Hits of `wave` that are first ones, or those that are not.
void take(const WaveHits& wave, bool is_first, WaveHits& out) {
  out.clear();
  out.viewing = wave.viewing;
  for (size_t i = 0; i < wave.size(); ++i) {
    if (is_direct_at(wave.walks[i]) != is_first) continue;
    out.walks.push_back(wave.walks[i]);
    if (!wave.hits.empty()) out.hits.push_back(wave.hits[i]);
    out.vertices.push_back(wave.vertices[i]);
    if (!wave.bsdfs.empty()) out.bsdfs.push_back(wave.bsdfs[i]);
    if (!wave.scatterings.empty()) out.scatterings.push_back(wave.scatterings[i]);
  }
}

}  // namespace

struct StagedDirect::Scratch final : DirectLightScratch {
  std::unique_ptr<DirectLightScratch> first, later;
  WaveHits part;
};

StagedDirect::StagedDirect(std::unique_ptr<DirectLight> first, std::unique_ptr<DirectLight> later)
    : first_(std::move(first)), later_(std::move(later)) {
  TROFFER_CHECK(first_->walked_part() == later_->walked_part());
}

std::unique_ptr<DirectLightScratch> StagedDirect::make_scratch() const {
  auto s = std::make_unique<Scratch>();
  s->first = first_->make_scratch();
  s->later = later_->make_scratch();
  return s;
}

void StagedDirect::begin(DirectLightScratch& scratch) const {
  auto& s = static_cast<Scratch&>(scratch);
  first_->begin(*s.first);
  later_->begin(*s.later);
}

void StagedDirect::queue(WaveHits& wave, DirectLightScratch& scratch, RadianceBatch& out,
                         Counters& counters) const {
  auto& s = static_cast<Scratch&>(scratch);
  const auto firsts = size_t(std::count_if(wave.walks.begin(), wave.walks.end(), is_direct_at));
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

// Emission that was run into competes with the samples of who lit the vertex before.
void StagedDirect::weigh(SeenEmission& seen) const {
  if (std::all_of(seen.walks.begin(), seen.walks.end(),
                  [](auto* w) { return w->scatterings <= 1; }))
    return first_->weigh(seen);
  for (const bool is_first : {true, false}) {
    SeenEmission part;
    std::vector<size_t> places;
    for (size_t i = 0; i < seen.size(); ++i) {
      if ((seen.walks[i]->scatterings <= 1) != is_first) continue;
      part.add(*seen.walks[i], seen.vertices[i], seen.radiance[i], seen.at_infinity[i]);
      places.push_back(i);
    }
    if (places.empty()) continue;
    (is_first ? first_ : later_)->weigh(part);
    for (size_t k = 0; k < places.size(); ++k) seen.weights[places[k]] = part.weights[k];
  }
}

}  // namespace troffer
