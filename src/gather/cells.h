// Light between surfaces, solved on cache cells (cells/cell_map.h, docs/method/cells.md), and its
// lookup by gather rays. Made by make_cells() (cell_builder.h); used by GatherPass and
// CellsIndirect. Any number of threads may call const functions, each with its own scratch.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "cells/cell_map.h"
#include "cells/noise_draws.h"
#include "gather/gather_walks.h"
#include "gather/lit_regions.h"

namespace troffer {

// Cost and quality of the cells.
struct CellStatistics {
  uint64_t cells = 0, entries = 0, rays = 0;
  int rounds = 0, iterations = 0;
  double size = 0;        // size of a cell, metres
  double typical = 0;     // mean luminance of indirect light in the picture
  double unresolved = 0;  // share of the asked light that comes by cells without a row
  double bytes = 0;
  double seconds = 0;
};

// Light that gather rays find, as irradiance: π × radiance.
struct GatheredLight {
  std::vector<Rgb> irradiance;         // per ray
  std::vector<float> half_difference;  // per ray: luminance, draw of the noise of cells (CellLight)
  std::vector<float> distance;  // metres to the first matte or black surface, all the way; 0: none
  NoiseDraws noise{};           // noise of the sum over all rays; 0 if unknown

  void reset(size_t rays);
};

// Irradiance at a place, straight from sources and reflected.
struct CellLightAt {
  Rgb direct, indirect;
};

struct CellsScratch {
  std::vector<Walk> walks;  // input
  GatheredLight light;      // result for `walks`

  // One part of the walks, with indices of its own.
  GatherScratch gather;
  std::vector<GatherArrival> arrivals, again;
  std::vector<uint64_t> voxels;  // per arrival
  GatheredLight part;
};

class Cells {
 public:
  Cells(const PreparedScene& scene, std::shared_ptr<const CellMap> map, std::vector<Rgb> direct,
        std::vector<Rgb> irradiance, std::vector<float> half_difference,
        std::vector<NoiseDraws> noise, const CellStatistics& statistics,
        std::shared_ptr<const MirrorImages> images, LitRegions bright)
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
  // True if gather() also returns draws of the noise of cells.
  bool has_noise_draws() const { return !noise_.empty(); }
  // Lit regions among the cells that the pilot saw.
  const LitRegions& lit_regions() const { return bright_; }

  // Makes gather rays resolve sub-cell features from here on (CellMap::resolve_narrow). Does
  // nothing if tests at some of these places show that it costs too much variance: amid clutter, or
  // where lights are hard to sample.
  void resolve_narrow_where_worth_it(std::span<const CellHit> places, uint64_t seed,
                                     Counters& counters);

  // Follows s.walks, of ascending indices below `rays`, and puts what they see into s.light.
  void gather(size_t rays, CellsScratch& s, Counters& counters) const;
  // Reads the indirect irradiance at a place seen from this distance, and a draw of the error of
  // its luminance (CellLight). False if there is no cell, or the distance is below CellMap::near().
  bool indirect_at(const CellHit& hit, float distance, Rgb& irradiance,
                   float& half_difference) const;
  // Reads all irradiance at a place, under the same terms.
  bool irradiance_at(const CellHit& hit, float distance, Rgb& irradiance,
                     float& half_difference) const;
  // Returns the irradiance of the finest cell there; black if there is none.
  CellLightAt light_at(const CellHit& hit) const;

 private:
  void gather_part(size_t rays, CellsScratch& s, Counters& counters) const;
  bool look_up(const GatherArrival& a, uint64_t voxel, int bounce, CellsScratch& s) const;
  double variance_of_rays(std::span<const CellHit> places, uint64_t seed, Counters& counters) const;

  std::shared_ptr<const CellMap> map_;
  std::vector<Rgb> direct_, irradiance_;
  std::vector<float> half_difference_;
  std::vector<NoiseDraws> noise_;  // empty: unknown
  CellStatistics statistics_;
  LitRegions bright_;
  bool resolves_narrow_ = false;
  GatherWalks walks_;
};

}  // namespace troffer
