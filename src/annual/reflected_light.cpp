#include "annual/reflected_light.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <mutex>

#include "annual/open_rays.h"
#include "base/simd.h"
#include "base/streams.h"
#include "base/units.h"

namespace troffer {

namespace {

constexpr size_t block = 16;  // sources solved together: floats of one cache line
constexpr int samples_near = 4, samples_far = 2;  // light samples of a cell per source
constexpr size_t rays_at_a_time = 4096;
constexpr int most_sweeps = 200;
constexpr double most_change = 5e-4;  // of a sweep, relative: far below the noise of rows

// Adds the light of all linked cells times the links' weights, channel by channel.
TROFFER_MULTIVERSION
void add_links(const CellLink* links, size_t n, const float* light, float* sum) {
  for (size_t k = 0; k < n; ++k) {
    const float* l = light + size_t(links[k].cell) * 3 * block;
    const Rgb w = links[k].weight;
    for (size_t i = 0; i < block; ++i) sum[i] += w.r * l[i];
    for (size_t i = 0; i < block; ++i) sum[block + i] += w.g * l[block + i];
    for (size_t i = 0; i < block; ++i) sum[2 * block + i] += w.b * l[2 * block + i];
  }
}

// The same for links that treat all channels alike, and luminances.
TROFFER_MULTIVERSION
void add_grey_links(const CellLink* links, size_t n, const float* light, float* sum) {
  for (size_t k = 0; k < n; ++k) {
    const float* l = light + size_t(links[k].cell) * block;
    const float w = links[k].weight.g;
    for (size_t i = 0; i < block; ++i) sum[i] += w * l[i];
  }
}

// Light of a block of sources on all cells.
class BlockSolver {
 public:
  BlockSolver(const TransportCells& cells, const Tracer& tracer, const OutsideSources& sources,
              size_t first, uint64_t seed)
      : cells_(cells),
        sources_(sources),
        first_(first),
        count_(std::min(block, sources.size() - first)),
        seed_(seed),
        channels_(cells.is_grey() ? 1 : 3),
        cell_floats_(channels_ * block),
        direct_(cells.cell_count() * cell_floats_, 0.0f),
        drawn_{draw(samples_near), draw(samples_far)},
        rays_(tracer) {}

  void solve() {
    light_up();
    total_ = direct_;
    // Few sources shine through one window; the rest needs no balance.
    if (std::none_of(direct_.begin(), direct_.end(), [](float d) { return d > 0; })) return;
    const size_t n = cells_.cell_count();
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
      double change = 0, sum = 0;
      for (size_t k = 0; k < n; ++k) relax(sweep % 2 == 0 ? k : n - 1 - k, change, sum);
      if (change <= most_change * sum) break;
    }
  }
  // Sets out[first + i] to a sensor's coefficients.
  void gather(size_t sensor, float* out) const {
    CellLight sum{};
    add(cells_.sensors().of(sensor), sum.data());
    add_outside(cells_.sensors_outside().of(sensor), sum.data());
    for (size_t i = 0; i < count_; ++i)
      out[first_ + i] =
          channels_ == 1 ? sum[i] : luminance({sum[i], sum[block + i], sum[2 * block + i]});
  }

 private:
  // A shadow ray under way: cell, source in the block, and what it brings if it is free.
  struct Sent {
    uint32_t cell, source;
    float weight;
  };

  DrawnSources draw(int samples) const {
    const uint64_t seed =
        hash_of(seed_, uint64_t(first_), uint64_t(samples), stream::annual_cell_light);
    return {sources_, first_, count_, samples, seed};
  }

  using CellLight = std::array<float, 3 * block>;  // of one cell

  void add(std::span<const CellLink> links, float* sum) const {
    (channels_ == 1 ? add_grey_links : add_links)(links.data(), links.size(), total_.data(), sum);
  }
  // Adds light of source i of the block to that of a cell.
  void add(const Rgb& light, size_t i, float* sum) const {
    if (channels_ == 1) {
      sum[i] += luminance(light);
      return;
    }
    for (size_t c = 0; c < 3; ++c) sum[c * block + i] += light[c];
  }
  void add_outside(std::span<const OutsideLink> ways, float* sum) const {
    for (const OutsideLink& w : ways)
      for (size_t i = 0; i < count_; ++i) {
        const float l = sources_.radiance(first_ + i, w.direction) * pi_f;
        if (l > 0) add(w.weight * l, i, sum);
      }
  }
  void relax(size_t cell, double& change, double& sum) {
    CellLight e;
    std::copy_n(&direct_[cell * cell_floats_], cell_floats_, e.begin());
    add(cells_.rows().of(cell), e.data());
    float* old = &total_[cell * cell_floats_];
    float moved = 0, all = 0;
    for (size_t i = 0; i < cell_floats_; ++i) {
      moved += std::abs(e[i] - old[i]);
      all += e[i];
      old[i] = e[i];
    }
    change += double(moved);
    sum += double(all);
  }
  // Direct light of all cells.
  void light_up() {
    for (size_t c = 0; c < cells_.cell_count(); ++c) {
      const std::span<const CellHit> hits = cells_.hits(c);
      add_outside(cells_.rows_outside().of(c), &direct_[c * cell_floats_]);
      if (hits.empty()) continue;
      Random random(hash_of(seed_, uint64_t(c), uint64_t(first_), stream::annual_cell_light));
      const DrawnSources& drawn = c < cells_.near_count() ? drawn_[0] : drawn_[1];
      for (size_t i = 0; i < count_; ++i)
        for (const OutsideSample& s : drawn.of(i, random))
          send(hits, uint32_t(c), uint32_t(i), s, random);
      if (rays_.size() >= rays_at_a_time) receive();
    }
    receive();
  }
  void send(std::span<const CellHit> hits, uint32_t cell, uint32_t source, const OutsideSample& s,
            Random& random) {
    const CellHit& hit = hits[random.next_u32() % hits.size()];
    const float cosine = dot(s.direction, hit.normal);
    if (!(cosine > 0) || !(dot(s.direction, hit.horizon) > 0)) return;
    rays_.add(hit, s.direction);
    sent_.push_back({cell, source, s.weight * cosine * cells_.coat_factor(hit, cosine)});
  }
  void receive() {
    rays_.trace();
    for (size_t k = 0; k < sent_.size(); ++k) {
      const Rgb open = rays_[k] * sent_[k].weight;
      if (!open.is_black()) add(open, sent_[k].source, &direct_[sent_[k].cell * cell_floats_]);
    }
    rays_.clear();
    sent_.clear();
  }

  const TransportCells& cells_;
  const OutsideSources& sources_;
  size_t first_, count_;
  uint64_t seed_;
  size_t channels_, cell_floats_;
  std::vector<float> direct_, total_;  // cell by cell, channel by channel
  std::array<DrawnSources, 2> drawn_;  // for near and for far cells
  OpenRays rays_;
  std::vector<Sent> sent_;
};

}  // namespace

std::vector<ReflectedReplicate> reflected_light(const PreparedScene& scene,
                                                std::span<const CellHit> sensors,
                                                const WeatherYear& year, const Compass& compass,
                                                const ReflectedOptions& options,
                                                const ProgressCallback& progress,
                                                const StopFlag& stop) {
  std::vector<ReflectedReplicate> replicates;
  for (int r = 0; r < replicate_count; ++r) {
    const uint64_t seed = hash_of(options.seed, uint64_t(r), stream::annual_replicates);
    Random shift(hash_of(seed, stream::annual_sun_grid));
    const double x = shift.next_double();
    ReflectedReplicate out{
        SunGrid(year.latitude_deg, year.steps, {x, shift.next_double()}), 0, 0, 0, {}};
    const OutsideSources sources(compass, out.suns.nodes());
    out.sources = sources.size();
    ReplicateKeeper* keeper = options.keeper;
    if (keeper != nullptr &&
        (keeper->find(size_t(r), sensors.size(), out) || !keeper->is_own(size_t(r)))) {
      replicates.push_back(std::move(out));
      continue;
    }
    const TransportCells cells(scene, sensors, options.rays, seed, options.threads, stop);
    if (stop.load()) break;
    out.cells = cells.cell_count();
    out.links = cells.rows().all().size();
    out.coefficients.resize(sensors.size() * out.sources);
    const size_t blocks = (sources.size() + block - 1) / block;
    std::atomic<size_t> done = 0;
    std::mutex telling;
    parallel_for(blocks, options.threads, [&](size_t b) {
      if (stop.load()) return;
      BlockSolver solver(cells, scene.tracer, sources, b * block, seed);
      solver.solve();
      for (size_t s = 0; s < sensors.size(); ++s)
        solver.gather(s, &out.coefficients[s * out.sources]);
      const double fraction = double(++done) / double(blocks);
      const std::lock_guard lock(telling);
      if (progress) progress((r + fraction) / replicate_count);
    });
    if (stop.load()) break;
    if (keeper != nullptr) keeper->keep(size_t(r), out);
    replicates.push_back(std::move(out));
  }
  return replicates;
}

}  // namespace troffer
