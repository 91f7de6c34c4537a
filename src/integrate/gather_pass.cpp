#include "integrate/gather_pass.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/random.h"

namespace troffer {

namespace {

constexpr int tile_side = 16;
constexpr uint32_t first_rays = 8;
constexpr float unit = 16;  // rays of a neighbour of weight 1 in fits
// Gathers that follow a curve on one sequence of numbers err by less, together, than as many
// independent ones, as which their spread counts them (measured: docs/cells.md).
constexpr double gain_of_order = 2;
constexpr uint32_t most_rays = 256;
// Radii in harmonic mean distances: within the first, light is nearly linear; beyond the second the
// fit's own error is more than it saves.
constexpr float near_radius = 0.06f, far_radius = 0.12f;
constexpr float least_pixels = 1.5f;
// Fits hold within this share of the distance, times the root of the asked error; at most so far.
constexpr float reach_of_error = 2, most_reach = 0.2f;
// Neighbours on either side that a fit looks at, of those within its radius.
constexpr int few_along = 4, many_along = 8;

// The place of a pixel on a Z curve through its tile.
uint32_t on_curve(uint32_t x, uint32_t y) {
  const auto spread = [](uint32_t v) {
    return (v & 1) | (v & 2) << 1 | (v & 4) << 2 | (v & 8) << 3;
  };
  return spread(x) | spread(y) << 1;
}

std::string name_of_record(const void*, size_t i) {
  return "gather ray " + std::to_string(i) + " of a tile";
}

}  // namespace

GatherPass::GatherPass(const Cells& cells, const PictureView& view, const GatherOptions& options,
                       const StopFlag& stop, GatherRecords& out)
    : cells_(cells),
      view_(view),
      options_(options),
      stop_(stop),
      out_(out),
      workers_(size_t(thread_count(options.threads))) {}

template <class Do>
bool GatherPass::over_tiles(std::vector<Tile>& tiles, Counters& counters, const Do& act) {
  parallel_for_slots(tiles.size(), options_.threads, [&](size_t t, size_t slot) {
    if (!stop_.load(std::memory_order_relaxed)) act(tiles[t], workers_[slot]);
  });
  for (Worker& w : workers_) {
    counters += w.counters;
    w.counters = {};
  }
  return !stop_.load();
}

bool GatherPass::run(const std::function<void(double)>& progress, Counters& counters) {
  const PixelWindow& w = out_.window_;
  std::vector<Tile> tiles;
  for (int y = w.y0 / tile_side * tile_side; y < w.y1; y += tile_side)
    for (int x = w.x0 / tile_side * tile_side; x < w.x1; x += tile_side) {
      Tile& t = tiles.emplace_back();
      t.x = x;
      t.y = y;
      t.pixels = {std::max(x, w.x0), std::max(y, w.y0), std::min(x + tile_side, w.x1),
                  std::min(y + tile_side, w.y1)};
    }
  const auto tell = [&](double share) {
    if (progress) progress(share);
  };
  if (!over_tiles(tiles, counters, [&](Tile& t, Worker& worker) { see(t, worker); })) return false;
  tell(0.3);
  join(tiles);
  wanted_.assign(out_.records_.size(), 0);
  const auto of_all = [&](const Tile& t, const auto& act) {
    for (int y = t.pixels.y0; y < t.pixels.y1; ++y)
      for (int x = t.pixels.x0; x < t.pixels.x1; ++x)
        out_.of_pixel(x, y, [&](uint32_t r) { act(x, y, r); });
  };
  if (!over_tiles(tiles, counters, [&](Tile& t, Worker&) {
        of_all(t, [&](int x, int y, uint32_t r) { wanted_[r] = further_rays(x, y, r); });
      }))
    return false;
  tell(0.4);
  if (!over_tiles(tiles, counters, [&](Tile& t, Worker& worker) { gather_further(t, worker); }))
    return false;
  tell(0.8);
  out_.fitted_.resize(out_.records_.size());
  return over_tiles(tiles, counters, [&](Tile& t, Worker&) {
    of_all(t, [&](int x, int y, uint32_t r) { out_.fitted_[r] = fitted(x, y, r); });
  });
}

// Through the middle of a pixel; spread: by how much the next pixel's ray is farther away, per
// metre along it.
Ray GatherPass::ray_of(int x, int y, float& spread) const {
  const float u = float(x) + 0.5f, v = float(y) + 0.5f;
  const Ray ray = view_.ray(u, v), beside = view_.ray(u + 1, v);
  spread = length(beside.direction - ray.direction) + length(beside.origin - ray.origin);
  return ray;
}

// The matte surfaces that the tile's pixels see, with a gather at each.
void GatherPass::see(Tile& tile, Worker& w) const {
  GatherScratch& g = w.viewing;
  g.walks.clear();
  std::vector<float> spreads;
  for (int y = tile.pixels.y0; y < tile.pixels.y1; ++y)
    for (int x = tile.pixels.x0; x < tile.pixels.x1; ++x) {
      Walk walk;
      walk.ray = ray_of(x, y, spreads.emplace_back());
      walk.index = uint32_t(g.walks.size());
      walk.stream = hash_of(options_.seed, uint64_t(x), uint64_t(y), uint64_t{0x7669'6577});
      g.walks.push_back(walk);
    }
  const size_t pixels = g.walks.size();
  const CheckContext context(&w, pixels, name_of_record);
  cells_.walks().follow(pixels, Coherence::coherent, g, w.counters);
  std::stable_sort(
      g.arrivals.begin(), g.arrivals.end(),
      [](const GatherArrival& a, const GatherArrival& b) { return a.walk.index < b.walk.index; });
  tile.counts.assign(pixels, 0);
  std::vector<uint32_t> places;
  for (const GatherArrival& a : g.arrivals) {
    if (a.walk.scatterings > 0) continue;  // seen in gloss: its cell does
    GatherRecord& r = tile.records.emplace_back();
    r.hit = a.hit;
    r.weight = luminance(a.walk.throughput) * inv_pi_f;
    r.spacing = spreads[a.walk.index] * std::max(a.length, 1e-6f);
    const int x = tile.pixels.x0 + int(a.walk.index) % tile.pixels.width(),
              y = tile.pixels.y0 + int(a.walk.index) / tile.pixels.width();
    places.push_back(on_curve(uint32_t(x - tile.x), uint32_t(y - tile.y)) |
                     uint32_t(tile.counts[a.walk.index]++) << 8);
  }
  gather(tile.records, std::vector<uint32_t>(tile.records.size(), first_rays), tile, places, false,
         w);
}

// places: of each record on the tile's curve, and above that which of its pixel's it is.
void GatherPass::gather(std::vector<GatherRecord>& records, const std::vector<uint32_t>& counts,
                        const Tile& tile, const std::vector<uint32_t>& places, bool is_further,
                        Worker& w) const {
  std::vector<Walk>& walks = w.cells.gather.walks;
  walks.clear();
  std::vector<uint32_t> owners;
  for (uint32_t r = 0; r < records.size(); ++r)
    for (uint32_t k = 0; k < counts[r]; ++k) {
      Walk walk;
      walk.index = uint32_t(owners.size());
      walk.stream =
          hash_of(options_.seed, uint64_t(tile.x), uint64_t(tile.y), places[r] >> 8, is_further);
      walk.sample = (places[r] & 255) * (is_further ? most_rays : first_rays) + k;
      owners.push_back(r);
      set_out(records[r].hit, direction_number(walk), walk);
      if (!walk.throughput.is_black()) walks.push_back(walk);
    }
  const CheckContext context(&w, owners.size(), name_of_record);
  cells_.gather(owners.size(), w.cells, w.counters);
  const GatheredLight& light = w.cells.light;
  for (size_t i = 0; i < owners.size(); ++i) {
    GatherRecord& r = records[owners[i]];
    r.rays += 1;
    if (!is_finite(light.irradiance[i])) continue;
    r.sum += light.irradiance[i];
    r.squares += sqr(luminance(light.irradiance[i]));
    r.half += light.half_difference[i];
    if (light.distance[i] > 0) {
      r.nearness += 1 / light.distance[i];
      r.bright_nearness += luminance(light.irradiance[i]) / light.distance[i];
    }
  }
}

// Records of all tiles, by pixels.
void GatherPass::join(std::vector<Tile>& tiles) {
  const PixelWindow& w = out_.window_;
  out_.first_.assign(size_t(w.width()) * size_t(w.height()) + 1, 0);
  const auto pixel = [&](int x, int y) {
    return size_t(y - w.y0) * size_t(w.width()) + size_t(x - w.x0);
  };
  const auto of_pixels = [&](const Tile& t, const auto& act) {
    size_t i = 0;
    for (int y = t.pixels.y0; y < t.pixels.y1; ++y)
      for (int x = t.pixels.x0; x < t.pixels.x1; ++x) act(pixel(x, y), t.counts[i++]);
  };
  for (const Tile& t : tiles)
    of_pixels(t, [&](size_t p, uint16_t count) { out_.first_[p + 1] = count; });
  for (size_t p = 1; p < out_.first_.size(); ++p) out_.first_[p] += out_.first_[p - 1];
  out_.records_.resize(out_.first_.back());
  for (Tile& t : tiles) {
    size_t from = 0;
    of_pixels(t, [&](size_t p, uint16_t count) {
      std::copy_n(t.records.begin() + std::ptrdiff_t(from), count,
                  out_.records_.begin() + std::ptrdiff_t(out_.first_[p]));
      from += count;
    });
    t.records = {};
  }
}

GatherPass::Surroundings GatherPass::around(int x, int y, uint32_t r) const {
  const GatherRecord& at = out_.records_[r];
  float nearness = 0, bright_nearness = 0, light = 0, rays = 0, variance = 0, records = 0;
  for (int j = y - 2; j <= y + 2; ++j)
    for (int i = x - 2; i <= x + 2; ++i)
      out_.of_pixel(i, j, [&](uint32_t o) {
        const GatherRecord& n = out_.records_[o];
        if (!is_one_surface(at.hit, n.hit, at.spacing)) return;
        nearness += n.nearness;
        bright_nearness += n.bright_nearness;
        light += luminance(n.sum);
        rays += n.rays;
        const float mean = luminance(n.sum) / n.rays;
        variance += std::max(n.squares / n.rays - mean * mean, 0.0f) * n.rays / (n.rays - 1) / unit;
        records += 1;
      });
  // Rays that bring much light tell more of how it changes than others do.
  return {std::max(nearness / std::max(rays, 1.0f), bright_nearness / std::max(light, 1e-30f)),
          variance / std::max(records, 1.0f)};
}

LinearFit GatherPass::fit(int x, int y, uint32_t r, float radius, int along) const {
  const GatherRecord& at = out_.records_[r];
  const int pixels = std::clamp(int(std::ceil(radius / at.spacing)), 1, most_pixels);
  const int step = std::max(1, pixels / along);
  const Frame frame(at.hit.horizon);
  const float scale = 1 / radius;
  LinearFit sums;
  for (int j = -pixels / step; j <= pixels / step; ++j)
    for (int i = -pixels / step; i <= pixels / step; ++i)
      out_.of_pixel(x + i * step, y + j * step, [&](uint32_t o) {
        const GatherRecord& n = out_.records_[o];
        const Vec3 d = (n.hit.position - at.hit.position) * scale;
        const float d2 = length_squared(d);
        if (d2 >= 1 || !is_one_surface(at.hit, n.hit, at.spacing)) return;
        sums.add(dot(d, frame.tangent), dot(d, frame.bitangent), 1 - d2, n.rays / unit,
                 n.sum / n.rays);
      });
  return sums;
}

// Few neighbours do not tell how far they are spread; their rays do.
FittedLight GatherPass::solved(const LinearFit& fit, const Surroundings& s) {
  constexpr int enough = 12;
  FittedLight light;
  fit.solve(light);
  if (fit.count() < enough) light.spread = std::max(light.spread, double(s.variance));
  return light;
}

// Of the luminance of irradiance at a record.
float GatherPass::allowed_error(const GatherRecord& r) const {
  const float own = luminance(r.sum) / r.rays;
  const float typical = float(options_.typical) / std::max(r.weight, 1e-4f);
  return float(options_.error) * 0.5f * (own + typical) + 1e-20f;
}

uint32_t GatherPass::further_rays(int x, int y, uint32_t r) const {
  const GatherRecord& at = out_.records_[r];
  const Surroundings s = around(x, y, r);
  const float radius =
      std::max(near_radius / std::max(s.nearness, 1e-20f), least_pixels * at.spacing);
  const FittedLight light =
      solved(fit(x, y, r, std::min(radius, most_pixels * at.spacing), few_along), s);
  const double wanted = light.spread / std::max(light.neighbours, 1.0) /
                        sqr(gain_of_order * double(allowed_error(at)));
  if (!(wanted > 1)) return 0;
  const double rays = std::min(first_rays * (wanted - 1), double(most_rays - first_rays));
  return uint32_t(rays / 4 + 0.999) * 4;
}

void GatherPass::gather_further(const Tile& tile, Worker& w) {
  std::vector<GatherRecord> records;
  std::vector<uint32_t> counts, places, numbers;
  for (int y = tile.pixels.y0; y < tile.pixels.y1; ++y)
    for (int x = tile.pixels.x0; x < tile.pixels.x1; ++x) {
      uint32_t number = 0;
      out_.of_pixel(x, y, [&](uint32_t r) {
        const uint32_t place = on_curve(uint32_t(x - tile.x), uint32_t(y - tile.y)) | number++ << 8;
        if (wanted_[r] == 0) return;
        records.push_back(out_.records_[r]);
        counts.push_back(wanted_[r]);
        places.push_back(place);
        numbers.push_back(r);
      });
    }
  gather(records, counts, tile, places, true, w);
  for (size_t i = 0; i < numbers.size(); ++i) out_.records_[numbers[i]] = records[i];
}

// As far as the noise asks for, and no farther.
FittedRecord GatherPass::fitted(int x, int y, uint32_t r) const {
  const GatherRecord& at = out_.records_[r];
  const Surroundings s = around(x, y, r);
  const float distance = 1 / std::max(s.nearness, 1e-20f);
  const float least = least_pixels * at.spacing, most = most_pixels * at.spacing;
  float radius = std::clamp(near_radius * distance, least, most);
  const FittedLight light = solved(fit(x, y, r, radius, few_along), s);
  const double allowed = double(allowed_error(at));
  const double excess = light.spread / std::max(light.neighbours, 1.0) / (allowed * allowed);
  radius *= float(std::clamp(std::sqrt(excess), 0.5, 2.0));
  radius = std::clamp(radius, least, std::clamp(far_radius * distance, least, most));
  const FittedLight fine = solved(fit(x, y, r, radius, many_along), s);
  const double noise = fine.spread / std::max(fine.neighbours, 1.0);
  // What is bent shows in a narrower fit, if its noise lets it: the error goes with the radius²
  const FittedLight narrow = solved(fit(x, y, r, 0.5f * radius, few_along), s);
  const double apart = double(luminance(narrow.value)) - double(luminance(fine.value));
  const double chance = 2 * narrow.spread / std::max(narrow.neighbours, 1.0);
  const double bend2 = std::max(apart * apart - chance, 0.0) * 16 / 9;
  const double half = double(at.half) / double(at.rays);
  // What it errs by elsewhere goes with the square of how far.
  const float reach =
      std::min(reach_of_error * std::sqrt(float(options_.error)), most_reach) * distance;
  return {fine.value, float(std::sqrt(noise + bend2 + half * half)),
          at.spacing > reach ? 0 : reach};
}

}  // namespace troffer
