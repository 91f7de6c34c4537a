#include "gather/cell_direct.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "base/error.h"
#include "base/random.h"
#include "base/streams.h"
#include "transport/costs.h"

namespace troffer {

namespace {

constexpr size_t cells_of_group = 32;
constexpr size_t hits_of_group = 64;

struct StreamedHit {
  const CellHit* hit;
  uint64_t stream;
};

struct Worker {
  std::vector<StreamedHit> hits;
  std::unique_ptr<DirectLightScratch> direct;
  WaveHits wave;
  RadianceBatch out;
  std::vector<uint32_t> certified, sampled;  // cells of a group
  std::vector<GatherArrival> arrivals;
  GatherScratch gather;
  Counters counters;
};

uint64_t spread_bits(uint64_t x) {  // moves 21 bits to every third place
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffffull;
  x = (x | x << 16) & 0x1f0000ff0000ffull;
  x = (x | x << 8) & 0x100f00f00f00f00full;
  x = (x | x << 4) & 0x10c30c30c30c30c3ull;
  return (x | x << 2) & 0x1249249249249249ull;
}

// Returns the cells from number `first` on, ordered along a space-filling curve.
std::vector<uint32_t> cells_in_order(const CellMap& map, size_t first) {
  std::vector<std::pair<uint64_t, uint32_t>> keys;
  keys.reserve(map.size() - first);
  for (auto c = uint32_t(first); c < map.size(); ++c) {
    uint64_t key = 0;
    for (size_t a = 0; a < 3; ++a) {
      const double voxel = double(map.position(c)[a]) / double(map.size_of_cells());
      key |= spread_bits(uint64_t(std::clamp(voxel + 0x1p20, 0.0, 0x1p21 - 1))) << a;
    }
    keys.emplace_back(key, c);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<uint32_t> order;
  order.reserve(keys.size());
  for (const auto& k : keys) order.push_back(k.second);
  return order;
}

std::string name_of_hit(const void*, size_t i) {
  return "cell hit " + std::to_string(i);
}

// Sets a cell's mean of n values, and half the difference of their halves.
template <typename F>
void set(CellDirectLight& light, uint32_t cell, size_t n, const F& value) {
  std::array<Rgb, 2> halves;
  for (size_t i = 0; i < n; ++i) {
    const Rgb e = value(i);
    if (is_finite(e)) halves[i < n / 2 ? 0 : 1] += e;
  }
  light.irradiance[cell] = n > 0 ? (halves[0] + halves[1]) / float(n) : Rgb{0};
  if (n >= 2)
    light.half_difference[cell] =
        luminance(halves[0]) / float(n / 2) - luminance(light.irradiance[cell]);
}

// Computes direct light at hits, each with its own random stream, into w.out.
void light_hits(const CellLighting& by, std::span<const StreamedHit> hits, Worker& w) {
  if (!w.direct) w.direct = by.direct.make_scratch();
  by.direct.begin({}, *w.direct);
  w.out.reset(hits.size());
  const CheckContext context(&w, hits.size(), name_of_hit);
  w.wave.clear();
  const auto send = [&] {
    if (w.wave.size() > 0) by.direct.queue(w.wave, *w.direct, w.out, w.counters);
    w.wave.clear();
  };
  for (uint32_t index = 0; index < hits.size(); ++index) {
    Walk walk;
    walk.index = index;
    walk.sample = 0;
    walk.stream = hits[index].stream;
    w.wave.walks.push_back(walk);
    w.wave.vertices.push_back(vertex_of(*hits[index].hit));
    w.wave.scatterings.emplace_back(by.walks.white_at(*hits[index].hit, pi_f)).is_low_variance =
        true;
    if (w.wave.size() == hits_of_group) send();
  }
  send();
  by.direct.flush(*w.direct, w.out, w.counters);
}

void light_group(const CellMap& map, const CellLighting& by, std::span<const uint32_t> cells,
                 Worker& w, CellDirectLight& light) {
  w.hits.clear();
  for (const uint32_t c : cells)
    for (const CellHit& hit : map.hits(c))
      w.hits.push_back({&hit, hash_of(by.seed, uint64_t(c), uint32_t(w.hits.size()),
                                      stream::direct_light_of_cells)});
  light_hits(by, w.hits, w);
  size_t index = 0;
  for (const uint32_t c : cells) {
    const size_t n = map.hits(c).size();
    set(light, c, n, [&](size_t) {
      const Rgb e = w.out.direct[index] + w.out.indirect[index];
      ++index;
      return e;
    });
  }
}

// Like light_group(), by light samples.
void sample_group(const CellMap& map, const CellLighting& by, std::span<const uint32_t> cells,
                  std::span<const uint16_t> samples, Worker& w, CellDirectLight& light) {
  w.arrivals.clear();
  for (const uint32_t c : cells)
    for (uint32_t k = 0; k < samples[c]; ++k) {
      const std::span<const CellHit> hits = map.hits(c);
      if (hits.empty()) break;
      GatherArrival& a = w.arrivals.emplace_back();
      a.walk.index = uint32_t(w.arrivals.size() - 1);
      a.walk.sample = k;
      a.walk.stream = hash_of(by.seed, uint64_t(c), stream::light_samples_of_cells);
      a.hit = hits[k * hits.size() / samples[c]];
    }
  const size_t n = w.arrivals.size();
  w.gather.light.reset(n);
  const CheckContext context(&w, n, name_of_hit);
  by.walks.sample_direct_light(w.arrivals, w.gather, w.counters);
  size_t index = 0;
  for (const uint32_t c : cells)
    set(light, c, map.hits(c).empty() ? 0 : samples[c], [&](size_t) {
      const Rgb e = (w.gather.light.direct[index] + w.gather.light.indirect[index]) * pi_f;
      ++index;
      return e;
    });
}

}  // namespace

void add_direct_light(const CellMap& map, const CellLighting& by, std::span<const uint16_t> samples,
                      size_t first_cell, CellDirectLight& light, Counters& counters) {
  const std::vector<uint32_t> order = cells_in_order(map, first_cell);
  light.irradiance.resize(map.size());
  light.half_difference.resize(map.size(), 0);
  std::vector<Worker> workers(size_t(thread_count(by.threads)));
  const auto cells_of = [&](size_t g) {
    const size_t first = g * cells_of_group;
    return std::span(order).subspan(first, std::min(cells_of_group, order.size() - first));
  };
  SharedWork work;
  work.items = (order.size() + cells_of_group - 1) / cells_of_group;
  work.threads = by.threads;
  work.act = [&](size_t g, size_t slot) {
    Worker& w = workers[slot];
    w.certified.clear();
    w.sampled.clear();
    for (const uint32_t c : cells_of(g))
      (c < samples.size() && samples[c] > 0 ? w.sampled : w.certified).push_back(c);
    if (!w.certified.empty()) light_group(map, by, w.certified, w, light);
    if (!w.sampled.empty()) sample_group(map, by, w.sampled, samples, w, light);
    return true;
  };
  work.save = [&](size_t g, SharedWork::Bytes& bytes) {
    for (const uint32_t c : cells_of(g)) {
      append(bytes, light.irradiance[c]);
      append(bytes, light.half_difference[c]);
    }
  };
  work.load = [&](size_t g, ByteReader in) {
    for (const uint32_t c : cells_of(g)) {
      light.irradiance[c] = in.next<Rgb>();
      light.half_difference[c] = in.next<float>();
    }
  };
  share(by.group, work, by.stop);
  for (const Worker& w : workers) counters += w.counters;
}

uint32_t samples_instead_of_proofs(const CellMap& map, const CellLighting& by,
                                   const CellLightNeed& need, Counters& counters) {
  constexpr size_t groups_tried = 16;
  constexpr uint32_t samples_tried = 32;
  constexpr double least = 8, most = 256;
  const std::vector<uint32_t> order = cells_in_order(map, 0);
  const size_t groups = (order.size() + cells_of_group - 1) / cells_of_group;
  CellDirectLight light{std::vector<Rgb>(map.size()), std::vector<float>(map.size(), 0)};
  const std::vector<uint16_t> samples(map.size(), samples_tried);
  Worker proofs, sampling;
  double variance = 0, squares = 0, cells_tried = 0;
  for (size_t k = 0; k < std::min(groups, groups_tried); ++k) {
    if (by.stop.load(std::memory_order_relaxed)) return 0;
    const size_t first = k * groups / std::min(groups, groups_tried) * cells_of_group;
    const std::span<const uint32_t> cells =
        std::span(order).subspan(first, std::min(cells_of_group, order.size() - first));
    light_group(map, by, cells, proofs, light);
    for (const uint32_t c : cells) squares += sqr(double(luminance(light.irradiance[c])));
    sample_group(map, by, cells, samples, sampling, light);
    for (const uint32_t c : cells)
      variance += samples_tried * sqr(double(light.half_difference[c]));
    cells_tried += double(cells.size());
  }
  counters += proofs.counters;
  counters += sampling.counters;
  if (!(squares > 0)) return 0;
  const double of_sample = cost_of(sampling.counters) / (cells_tried * samples_tried),
               of_proofs = cost_of(proofs.counters) / cells_tried,
               budget = need.rays / double(map.size()),
               wanted = variance / (sqr(need.error) * squares);
  if (of_proofs <= std::min(wanted * of_sample, budget)) return 0;
  return uint32_t(std::clamp(wanted, least, std::clamp(budget / of_sample, least, most)));
}

std::vector<Rgb> direct_light_at(std::span<const CellHit> places, const CellLighting& by,
                                 Counters& counters) {
  std::vector<Rgb> irradiance(places.size());
  std::vector<Worker> workers(size_t(thread_count(by.threads)));
  const size_t groups = (places.size() + hits_of_group - 1) / hits_of_group;
  parallel_for_slots(groups, by.threads, [&](size_t g, size_t slot) {
    if (by.stop.load(std::memory_order_relaxed)) return;
    Worker& w = workers[slot];
    const size_t first = g * hits_of_group, end = std::min(first + hits_of_group, places.size());
    w.hits.clear();
    for (size_t i = first; i < end; ++i)
      w.hits.push_back({&places[i], hash_of(by.seed, uint64_t(i), stream::direct_light_of_places)});
    light_hits(by, w.hits, w);
    for (size_t i = first; i < end; ++i)
      irradiance[i] = w.out.direct[i - first] + w.out.indirect[i - first];
  });
  for (const Worker& w : workers) counters += w.counters;
  return irradiance;
}

}  // namespace troffer
