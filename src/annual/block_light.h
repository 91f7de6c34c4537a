// Direct light of cells from one block of sources outside, in the scene that all states share
// (state_family.h). Shadow rays that meet the region of a state are listed, so that the state
// traces them in its own scene. All other rays have the same result there.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "annual/open_rays.h"
#include "annual/outside_sources.h"
#include "annual/transport_cells.h"

namespace troffer {

// Some sources that are solved together, and samples of them.
class SourceBlock {
 public:
  static constexpr size_t most = 16;  // sources: floats of one cache line

  // numbers: of the sources, at least one. Must outlive this.
  SourceBlock(const OutsideSources& sources, std::span<const uint32_t> numbers, uint64_t seed);

  size_t count() const { return numbers_.size(); }
  uint32_t number(size_t i) const { return numbers_[i]; }  // among all sources
  // Radiance that a ray leaving the scene sees, per unit of source i of the block.
  float radiance(size_t i, const Vec3& direction) const {
    return sources_.radiance(numbers_[i], direction);
  }
  // Calls send(hit, source in the block, direction, weight, cosine) for shadow rays of a cell from
  // some of its places. An open ray brings the weight times the cosine.
  template <class Send>
  void draw(uint32_t cell, bool is_near, std::span<const CellHit> places, const Send& send) const {
    if (places.empty()) return;
    Random random(seed_of(cell));
    const DrawnSources& drawn = drawn_[is_near ? 0 : 1];
    for (size_t i = 0; i < count(); ++i)
      for (const OutsideSample& s : drawn.of(i, random)) {
        const CellHit& hit = places[random.next_u32() % places.size()];
        const float cosine = dot(s.direction, hit.normal);
        if (cosine > 0 && dot(s.direction, hit.horizon) > 0)
          send(hit, uint32_t(i), s.direction, s.weight, cosine);
      }
  }

 private:
  DrawnSources draw_sources(int samples) const;
  uint64_t seed_of(uint32_t cell) const;

  const OutsideSources& sources_;
  std::span<const uint32_t> numbers_;
  uint64_t seed_;
  std::array<DrawnSources, 2> drawn_;  // for near and for far cells
};

// Light of a source of a block that reaches a cell, as irradiance.
struct SharedCellLight {
  uint32_t cell = 0, source = 0;
  Rgb light;
  uint32_t crossing = 0;  // number of the ray in SharedBlockLight::crossing, or no_crossing
};

class SharedBlockLight {
 public:
  static constexpr uint32_t no_crossing = 0xffffffffu;
  // A ray that meets the region of some state. It brings `weight` where it is open.
  struct CrossingRay {
    Ray ray;
    uint32_t cell = 0, source = 0;
    float weight = 0;
  };

  // tracer: of the scene that the cells were made in.
  SharedBlockLight(const TransportCells& cells, const Tracer& tracer, const SourceBlock& block,
                   const RayRegions& regions);

  const std::vector<SharedCellLight>& lights() const { return lights_; }
  const std::vector<CrossingRay>& crossing() const { return crossing_; }
  // Indices into crossing().
  const std::vector<uint32_t>& crossing_of(size_t region) const { return of_region_[region]; }

 private:
  void receive(OpenRays& rays);

  std::vector<SharedCellLight> lights_;
  std::vector<CrossingRay> crossing_;
  std::vector<std::vector<uint32_t>> of_region_;
  std::vector<CrossingRay> sent_;          // rays under way; `ray` is not set
  std::vector<uint32_t> crossing_number_;  // of those rays
};

}  // namespace troffer
