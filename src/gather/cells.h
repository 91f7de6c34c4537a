// Light between surfaces, solved on cells (cells/cell_map.h, docs/cells.md): what is left of it
// once they are made, and how places around look it up.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "cells/cell_map.h"
#include "cells/noise_draws.h"
#include "gather/bright_places.h"
#include "gather/gather_walks.h"

namespace troffer {

// What making the cells took, and how well it came out.
struct CellStatistics {
  uint64_t cells = 0, entries = 0, rays = 0;
  int rounds = 0, iterations = 0;
  double size = 0;        // of a cell, metres
  double typical = 0;     // luminance of indirect light in the picture
  double unresolved = 0;  // share of the light asked for that cells without a row would bring
  double bytes = 0;
  double seconds = 0;
};

// What lookups bring a ray: irradiance over π would be radiance.
struct GatheredLight {
  std::vector<Rgb> irradiance;         // of each ray: π × radiance
  std::vector<float> half_difference;  // by the noise of cells: luminance (CellLight)
  std::vector<float> distance;  // to the first surface that is matte or black, all the way; 0: none
  NoiseDraws noise{};           // of the sum of all rays; 0: none are known

  void reset(size_t rays);
};

// Irradiance at a place.
struct CellLightAt {
  Rgb direct, indirect;
};

struct CellsScratch {
  std::vector<Walk> walks;  // to be followed
  GatheredLight light;      // what they bring

  // Of some of them, by indices of their own.
  GatherScratch gather;
  std::vector<GatherArrival> arrivals, again;
  std::vector<uint64_t> voxels;  // of arrivals
  GatheredLight part;
};

class Cells {
 public:
  Cells(const PreparedScene& scene, std::shared_ptr<const CellMap> map, std::vector<Rgb> direct,
        std::vector<Rgb> irradiance, std::vector<float> half_difference,
        std::vector<NoiseDraws> noise, const CellStatistics& statistics,
        std::shared_ptr<const MirrorImages> images, BrightPlaces bright)
      : map_(std::move(map)),
        direct_(std::move(direct)),
        irradiance_(std::move(irradiance)),
        half_difference_(std::move(half_difference)),
        noise_(std::move(noise)),
        statistics_(statistics),
        bright_(std::move(bright)),
        walks_(scene, std::move(images)) {}

  const CellStatistics& statistics() const { return statistics_; }
  const GatherWalks& walks() const { return walks_; }
  // Whether what gather() brings comes with draws of what it is off by.
  bool tells_noise() const { return !noise_.empty(); }
  // For what the pilot asks for.
  const BrightPlaces& bright_places() const { return bright_; }

  // From here on rays that gather look closely at narrow things (CellMap::look_closely), unless
  // they would err so much more at some of these places that it is not worth it: amid clutter, or
  // where lights are hard to draw.
  void look_closely_where_worth_it(std::span<const CellHit> places, uint64_t seed,
                                   Counters& counters);

  // Follows s.walks, of ascending indices below `rays`, and gathers what they see: s.light.
  void gather(size_t rays, CellsScratch& s, Counters& counters) const;
  // Irradiance at a place seen from this far, but for what comes straight from sources, and a draw
  // of the error of its luminance (CellLight); false where there is no cell that is good enough.
  bool indirect_at(const CellHit& hit, float distance, Rgb& irradiance,
                   float& half_difference) const;
  // That of the cell there; black where there is none.
  CellLightAt light_at(const CellHit& hit) const;

 private:
  void gather_part(size_t rays, CellsScratch& s, Counters& counters) const;
  bool look_up(const GatherArrival& a, uint64_t voxel, int bounce, CellsScratch& s) const;
  double variance_of_rays(std::span<const CellHit> places, uint64_t seed, Counters& counters) const;

  std::shared_ptr<const CellMap> map_;
  std::vector<Rgb> direct_, irradiance_;
  std::vector<float> half_difference_;
  std::vector<NoiseDraws> noise_;  // empty: not known
  CellStatistics statistics_;
  BrightPlaces bright_;
  bool looks_closely_ = false;
  GatherWalks walks_;
};

}  // namespace troffer
