#include "gather/gather_pass.h"

#include <algorithm>

#include "base/error.h"
#include "base/random.h"
#include "base/streams.h"
#include "gather/gather_lobe.h"
#include "gather/gather_thinning.h"

namespace troffer {

namespace {

// Returns a pixel's place on a Z curve through its tile. The last two bits say which of four
// lattices it is on.
uint32_t on_curve(uint32_t x, uint32_t y) {
  const auto spread = [](uint32_t v) {
    return (v & 1) | (v & 2) << 1 | (v & 4) << 2 | (v & 8) << 3;
  };
  return spread(x) | spread(y) << 1;
}

uint32_t class_of(uint32_t place) {
  return place & 3;
}

// Sets the width of the record's gloss. Returns the lobe for its rays: empty without gloss or rays.
GatherLobe make_lobe(const GatherWalks& walks, uint32_t rays, GatherRecord& r) {
  if (!r.place.is_there()) return {};
  const Bsdf specular = walks.scattering_at(r.place).specular;
  r.width = glossy_alpha(specular);
  if (rays == 0) return {};
  return {specular, r.hit.normal, r.place.wo, r.matte.weight * pi_f, r.gloss.weight};
}

void add(GatherSums& sums, const Rgb& light, float half, float nearness) {
  sums.sum += light;
  sums.squares += sqr(luminance(light));
  sums.half += half;
  sums.bright_nearness += luminance(light) * nearness;
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
      workers_(size_t(thread_count(options.threads))),
      is_thinned_(has_close_pixels(cells, view, options.seed, workers_[0].viewing,
                                   workers_[0].cells, workers_[0].counters)),
      fits_(out, options, is_thinned_) {}

bool GatherPass::over_tiles(std::vector<Tile>& tiles, SharedWork work, Counters& counters) {
  work.items = tiles.size();
  work.threads = options_.threads;
  const bool is_done = share(options_.group, work, stop_);
  for (Worker& w : workers_) {
    counters += w.counters;
    w.counters = {};
  }
  return is_done && !stop_.load();
}

bool GatherPass::see_all(std::vector<Tile>& tiles, Counters& counters) {
  SharedWork work;
  work.act = [&](size_t t, size_t slot) {
    see(tiles[t], workers_[slot]);
    return true;
  };
  work.save = [&](size_t t, SharedWork::Bytes& out) {
    append_all(out, std::span<const GatherRecord>(tiles[t].records));
    append_all(out, std::span<const uint16_t>(tiles[t].counts));
    append_all(out, std::span<const float>(tiles[t].sight.visible));
    append(out, tiles[t].sight.rest);
  };
  work.load = [&](size_t t, ByteReader in) {
    tiles[t].records = next_all<GatherRecord>(in);
    tiles[t].counts = next_all<uint16_t>(in);
    tiles[t].sight.visible = next_all<float>(in);
    tiles[t].sight.rest = in.next<float>();
  };
  return over_tiles(tiles, std::move(work), counters);
}

bool GatherPass::gather_wanted(std::vector<Tile>& tiles, Rays which, Counters& counters) {
  SharedWork work;
  work.act = [&](size_t t, size_t slot) {
    gather_wanted(tiles[t], which, workers_[slot]);
    return true;
  };
  const auto wanting = [&](size_t t, const auto& visit) {
    records_of(tiles[t], [&](int, int, uint32_t r) {
      if (wanted_[r] > 0) visit(out_.records_[r]);
    });
  };
  work.save = [&](size_t t, SharedWork::Bytes& out) {
    wanting(t, [&](const GatherRecord& r) {
      append(out, r.rays);
      append(out, r.nearness);
      append(out, r.matte);
      append(out, r.gloss);
    });
  };
  work.load = [&](size_t t, ByteReader in) {
    wanting(t, [&](GatherRecord& r) {
      r.rays = in.next<float>();
      r.nearness = in.next<float>();
      r.matte = in.next<GatherSums>();
      r.gloss = in.next<GatherSums>();
    });
  };
  return over_tiles(tiles, std::move(work), counters);
}

bool GatherPass::run(const std::function<void(double)>& progress, Counters& counters) {
  constexpr int tile_side = GatherRecords::tile_side;
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
  if (!see_all(tiles, counters)) return false;
  tell(0.3);
  join(tiles);
  std::vector<uint8_t>& behind_edge = fits_.behind_edge();
  behind_edge.resize(out_.records_.size());
  if (!for_records(tiles, counters, behind_edge, [&](int x, int y, uint32_t r) {
        return uint8_t(fits_.is_behind_edge(x, y, r));
      }))
    return false;
  if (is_thinned_ && !thin(tiles, counters)) return false;
  wanted_.assign(out_.records_.size(), 0);
  fits_.usual_rays().assign(out_.records_.size(), float(GatherFits::first_rays));
  if (!for_records(tiles, counters, wanted_,
                   [&](int x, int y, uint32_t r) { return fits_.further_rays(x, y, r); }))
    return false;
  tell(0.4);
  if (!gather_wanted(tiles, Rays::further, counters)) return false;
  if (!for_records(tiles, counters, fits_.usual_rays(),
                   [&](int x, int y, uint32_t r) { return fits_.usual_rays(x, y, r); }))
    return false;
  tell(0.8);
  for (const Tile& t : tiles) {
    out_.visible_.insert(out_.visible_.end(), t.sight.visible.begin(), t.sight.visible.end());
    out_.rest_.push_back(t.sight.rest);
  }
  out_.fitted_.resize(out_.records_.size());
  return for_records(tiles, counters, out_.fitted_,
                     [&](int x, int y, uint32_t r) { return fits_.fitted(x, y, r); });
}

// Leaves out redundant records, and gathers first rays at remaining records without any.
bool GatherPass::thin(std::vector<Tile>& tiles, Counters& counters) {
  std::vector<uint8_t> flags(out_.records_.size());
  if (!for_records(tiles, counters, flags, [&](int x, int y, uint32_t r) {
        return uint8_t(is_redundant(out_, fits_, x, y, r));
      }))
    return false;
  out_.leave_out(flags);
  std::vector<uint8_t>& behind_edge = fits_.behind_edge();
  size_t kept = 0;
  for (size_t r = 0; r < flags.size(); ++r)
    if (flags[r] == 0) behind_edge[kept++] = behind_edge[r];
  behind_edge.resize(kept);
  wanted_.resize(out_.records_.size());
  for (size_t r = 0; r < wanted_.size(); ++r)
    wanted_[r] = out_.records_[r].rays == 0 ? GatherFits::first_rays : 0;
  return gather_wanted(tiles, Rays::first, counters);
}

// Finds the matte surfaces that the tile's pixels see, and gathers at each, or under thinning at
// those of lattice pixels.
void GatherPass::see(Tile& tile, Worker& w) const {
  GatherScratch& g = w.viewing;
  g.walks.clear();
  std::vector<float> spreads;
  for (int y = tile.pixels.y0; y < tile.pixels.y1; ++y)
    for (int x = tile.pixels.x0; x < tile.pixels.x1; ++x) {
      Walk walk;
      walk.ray = view_.pixel_ray(x, y, spreads.emplace_back());
      walk.index = uint32_t(g.walks.size());
      walk.stream = hash_of(options_.seed, uint64_t(x), uint64_t(y), stream::gather_records);
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
    if (a.walk.scatterings > 0) continue;  // seen in gloss: viewing rays read its cell
    GatherRecord& r = tile.records.emplace_back();
    r.hit = a.hit;
    r.matte.weight = luminance(a.walk.throughput) * inv_pi_f;
    r.gloss.weight = a.gloss_weight;
    r.place = a.gloss;
    r.spacing = spreads[a.walk.index] * std::max(a.length, 1e-6f);
    const int x = tile.pixels.x0 + int(a.walk.index) % tile.pixels.width(),
              y = tile.pixels.y0 + int(a.walk.index) / tile.pixels.width();
    places.push_back(on_curve(uint32_t(x - tile.x), uint32_t(y - tile.y)) |
                     uint32_t(tile.counts[a.walk.index]++) << 8);
  }
  std::vector<uint32_t> counts(tile.records.size(), GatherFits::first_rays);
  if (is_thinned_)
    for (size_t r = 0; r < counts.size(); ++r)
      if (class_of(places[r]) != 0) counts[r] = 0;
  constexpr size_t rays_for_sight = 4;  // gather rays per visibility test
  std::vector<CellHit> from;
  size_t rays = 0;
  for (size_t r = 0; r < counts.size(); ++r) {
    if (counts[r] > 0) from.push_back(tile.records[r].hit);
    rays += counts[r];
  }
  tile.sight = cells_.lit_regions().visibility_from(from, rays / rays_for_sight);
  GuidingStatistics tally;
  gather(tile.records, counts, tile, places, Rays::first, w, &tally);
  tally.tell(tile.sight);
}

// places: of each record, its pixel on the tile's curve (8 bits) and its number within the pixel
// (above).
void GatherPass::gather(std::vector<GatherRecord>& records, const std::vector<uint32_t>& counts,
                        const Tile& tile, const std::vector<uint32_t>& places, Rays which,
                        Worker& w, GuidingStatistics* tally) const {
  std::vector<Walk>& walks = w.cells.walks;
  walks.clear();
  std::vector<uint32_t> owners;
  std::vector<Vec3> directions;
  std::vector<float> shares;   // per ray: the coat's factor for its light
  std::vector<float> weights;  // per ray: what it counts relative to a cosine-distributed one
  std::vector<GatherLobe> lobes;
  std::vector<GatherDistribution> aims;
  const bool is_further = which == Rays::further;
  for (uint32_t r = 0; r < records.size(); ++r) {
    const GatherLobe& lobe = lobes.emplace_back(make_lobe(cells_.walks(), counts[r], records[r]));
    // Each lattice has its own sequence, which is stratified even where only the first lattice is
    // used.
    const uint32_t lattice = is_thinned_ ? class_of(places[r]) : 0,
                   place = (places[r] & 255) >> (is_thinned_ ? 2 : 0);
    const Bsdf coat = cells_.walks().coat_at(records[r].hit);
    const GatherDistribution& aim =
        aims.emplace_back(cells_.lit_regions(), tile.sight, records[r].hit);
    for (uint32_t k = 0; k < counts[r]; ++k) {
      Walk walk;
      walk.index = uint32_t(owners.size());
      walk.stream = hash_of(options_.seed, uint64_t(tile.x), uint64_t(tile.y), places[r] >> 8,
                            uint32_t(is_further) | lattice << 1);
      walk.sample = place * (is_further ? GatherFits::most_rays : GatherFits::first_rays) + k;
      owners.push_back(r);
      weights.push_back(set_out(records[r].hit, aim, lobe, walk));
      directions.push_back(walk.ray.direction);
      shares.push_back(coat_share(coat, walk.pdf * pi_f));
      if (!walk.throughput.is_black()) walks.push_back(walk);
    }
  }
  const CheckContext context(&w, owners.size(), name_of_record);
  cells_.gather(owners.size(), w.cells, w.counters);
  const GatheredLight& light = w.cells.light;
  for (size_t i = 0; i < owners.size(); ++i) {
    GatherRecord& r = records[owners[i]];
    r.rays += 1;
    if (!is_finite(light.irradiance[i])) continue;
    const float nearness = light.distance[i] > 0 ? 1 / light.distance[i] : 0;
    r.nearness += nearness * weights[i];
    if (tally != nullptr)
      tally->add(aims[owners[i]], directions[i], weights[i], luminance(light.irradiance[i]));
    add(r.matte, light.irradiance[i] * shares[i], light.half_difference[i] * shares[i], nearness);
    if (!r.place.is_there()) continue;
    const Rgb share = lobes[owners[i]].share_of(directions[i]);
    add(r.gloss, light.irradiance[i] * share, light.half_difference[i] * luminance(share),
        nearness);
  }
}

// Joins the records of all tiles, pixel by pixel.
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

void GatherPass::gather_wanted(const Tile& tile, Rays which, Worker& w) {
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
  gather(records, counts, tile, places, which, w);
  for (size_t i = 0; i < numbers.size(); ++i) out_.records_[numbers[i]] = records[i];
}

}  // namespace troffer
