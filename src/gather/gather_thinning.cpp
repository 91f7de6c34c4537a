#include "gather/gather_thinning.h"

#include <algorithm>

#include "base/ablation.h"
#include "base/random.h"
#include "base/streams.h"

namespace troffer {

namespace {

// Pixels within the radius in which light is nearly linear: with this many, pixels off the lattice
// need no record.
constexpr float least_radius = 6;

}  // namespace

bool has_close_pixels(const Cells& cells, const PictureView& view, uint64_t seed,
                      GatherScratch& viewing, CellsScratch& gathering, Counters& counters) {
  if (is_left_out<"thinning">()) return false;
  constexpr int along = 24, rays = 4;
  constexpr int64_t least_pixels = 40'000;
  const PixelWindow& image = view.image;
  if (int64_t(image.width()) * image.height() < least_pixels) return false;
  GatherScratch& g = viewing;
  g.walks.clear();
  std::vector<float> spreads;
  for (int j = 0; j < along; ++j)
    for (int i = 0; i < along; ++i) {
      Walk walk;
      walk.ray = view.pixel_ray(image.x0 + (2 * i + 1) * image.width() / (2 * along),
                                image.y0 + (2 * j + 1) * image.height() / (2 * along),
                                spreads.emplace_back());
      walk.index = uint32_t(g.walks.size());
      walk.stream = hash_of(seed, walk.index, stream::thinning_sight);
      g.walks.push_back(walk);
    }
  cells.walks().follow(g.walks.size(), Coherence::none, g, counters);
  std::vector<float> spacings;
  std::vector<Walk>& walks = gathering.walks;
  walks.clear();
  uint32_t asked = 0;
  for (const GatherArrival& a : g.arrivals) {
    if (a.walk.scatterings > 0) continue;
    spacings.push_back(spreads[a.walk.index] * std::max(a.length, 1e-6f));
    for (int k = 0; k < rays; ++k) {
      Walk walk;
      walk.index = asked;
      walk.stream = hash_of(seed, stream::thinning_rays);
      walk.sample = asked++;
      set_out(a.hit, direction_number(walk), walk);
      if (!walk.throughput.is_black()) walks.push_back(walk);
    }
  }
  cells.gather(asked, gathering, counters);
  size_t close = 0;
  for (size_t p = 0; p < spacings.size(); ++p) {
    float nearness = 0;
    for (size_t k = 0; k < rays; ++k)
      if (const float d = gathering.light.distance[rays * p + k]; d > 0) nearness += 1 / d / rays;
    close += GatherFits::near_radius > least_radius * spacings[p] * nearness;
  }
  return 2 * close > spacings.size();
}

bool is_redundant(const GatherRecords& records, GatherFits& fits, int x, int y, uint32_t r) {
  using Part = GatherFits::Part;
  const std::vector<uint8_t>& behind_edge = fits.behind_edge();
  const GatherRecord& at = records.all()[r];
  if (GatherFits::is_on_lattice(x, y) || behind_edge[r] != 0) return false;
  int around_it = 0, alike = 0;
  for (int j = y - (y & 1); j <= y + (y & 1); j += 2)
    for (int i = x - (x & 1); i <= x + (x & 1); i += 2) {
      bool is_alike = false;
      records.of_pixel(i, j, [&](uint32_t o) {
        const Part part = at.place.is_there() ? &GatherRecord::gloss : &GatherRecord::matte;
        is_alike |= behind_edge[o] == 0 && fits.is_neighbour(r, o, part);
      });
      ++around_it;
      alike += is_alike;
    }
  if (alike < around_it) return false;
  const auto is_linear = [&](Part part) {
    return GatherFits::near_radius >
           least_radius * at.spacing * fits.around(x, y, r, part).nearness;
  };
  return is_linear(&GatherRecord::matte) &&
         (!at.place.is_there() || is_linear(&GatherRecord::gloss));
}

}  // namespace troffer
