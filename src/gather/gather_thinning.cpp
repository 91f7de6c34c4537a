// Leaves out records in large pictures of rooms, where pixels are closer together than light
// changes.
#include "gather/gather_pass.h"

#include <algorithm>

#include "base/random.h"
#include "base/streams.h"

namespace troffer {

namespace {

// Pixels within the radius in which light is nearly linear: with this many, pixels off the lattice
// need no record.
constexpr float least_radius = 6;

}  // namespace

// True if most pixels of the whole picture are so close. False for small pictures, which gain
// nothing.
bool GatherPass::has_close_pixels(Worker& w) const {
  constexpr int along = 24, rays = 4;
  constexpr int64_t least_pixels = 40'000;
  const PixelWindow& image = view_.image;
  if (int64_t(image.width()) * image.height() < least_pixels) return false;
  GatherScratch& g = w.viewing;
  g.walks.clear();
  std::vector<float> spreads;
  for (int j = 0; j < along; ++j)
    for (int i = 0; i < along; ++i) {
      Walk walk;
      walk.ray =
          ray_of(image.x0 + (2 * i + 1) * image.width() / (2 * along),
                 image.y0 + (2 * j + 1) * image.height() / (2 * along), spreads.emplace_back());
      walk.index = uint32_t(g.walks.size());
      walk.stream = hash_of(options_.seed, walk.index, stream::thinning_sight);
      g.walks.push_back(walk);
    }
  cells_.walks().follow(g.walks.size(), Coherence::none, g, w.counters);
  std::vector<float> spacings;
  std::vector<Walk>& walks = w.cells.walks;
  walks.clear();
  uint32_t asked = 0;
  for (const GatherArrival& a : g.arrivals) {
    if (a.walk.scatterings > 0) continue;
    spacings.push_back(spreads[a.walk.index] * std::max(a.length, 1e-6f));
    for (int k = 0; k < rays; ++k) {
      Walk walk;
      walk.index = asked;
      walk.stream = hash_of(options_.seed, stream::thinning_rays);
      walk.sample = asked++;
      set_out(a.hit, direction_number(walk), walk);
      if (!walk.throughput.is_black()) walks.push_back(walk);
    }
  }
  cells_.gather(asked, w.cells, w.counters);
  size_t close = 0;
  for (size_t p = 0; p < spacings.size(); ++p) {
    float nearness = 0;
    for (size_t k = 0; k < rays; ++k)
      if (const float d = w.cells.light.distance[rays * p + k]; d > 0) nearness += 1 / d / rays;
    close += near_radius > least_radius * spacings[p] * nearness;
  }
  return 2 * close > spacings.size();
}

// True if the records of lattice pixels around say all about this one: all see the same surface,
// and light is nearly linear between them.
bool GatherPass::is_redundant(int x, int y, uint32_t r) const {
  const GatherRecord& at = out_.records_[r];
  if (is_on_lattice(x, y) || beside_[r] != 0) return false;
  int around_it = 0, alike = 0;
  for (int j = y - (y & 1); j <= y + (y & 1); j += 2)
    for (int i = x - (x & 1); i <= x + (x & 1); i += 2) {
      bool is_alike = false;
      out_.of_pixel(i, j, [&](uint32_t o) {
        const Part part = at.place.is_there() ? &GatherRecord::gloss : &GatherRecord::matte;
        is_alike |= beside_[o] == 0 && is_neighbour(r, o, part);
      });
      ++around_it;
      alike += is_alike;
    }
  if (alike < around_it) return false;
  const auto is_linear = [&](Part part) {
    return near_radius > least_radius * at.spacing * around(x, y, r, part).nearness;
  };
  return is_linear(&GatherRecord::matte) &&
         (!at.place.is_there() || is_linear(&GatherRecord::gloss));
}

// Leaves out such records, and gathers first rays at remaining records without any.
bool GatherPass::thin(std::vector<Tile>& tiles, Counters& counters) {
  std::vector<uint8_t> is_left_out(out_.records_.size());
  if (!for_records(tiles, counters, is_left_out,
                   [&](int x, int y, uint32_t r) { return uint8_t(is_redundant(x, y, r)); }))
    return false;
  leave_out(is_left_out);
  wanted_.resize(out_.records_.size());
  for (size_t r = 0; r < wanted_.size(); ++r)
    wanted_[r] = out_.records_[r].rays == 0 ? first_rays : 0;
  return gather_wanted(tiles, Rays::first, counters);
}

void GatherPass::leave_out(const std::vector<uint8_t>& is_left_out) {
  uint32_t kept = 0, from = 0;
  for (size_t p = 0; p + 1 < out_.first_.size(); ++p) {
    const uint32_t end = out_.first_[p + 1];
    out_.first_[p] = kept;
    for (; from < end; ++from) {
      if (is_left_out[from] != 0) continue;
      out_.records_[kept] = out_.records_[from];
      beside_[kept++] = beside_[from];
    }
  }
  out_.first_.back() = kept;
  out_.records_.resize(kept);
  out_.records_.shrink_to_fit();
  beside_.resize(kept);
}

}  // namespace troffer
