#include "annual/block_solver.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "base/simd.h"
#include "base/units.h"

namespace troffer {

namespace {

constexpr size_t width = SourceBlock::most;
constexpr int most_sweeps = 200;
constexpr double most_change = 5e-4;  // of a sweep, relative: far below the noise of rows

// Light of one cell by all sources of a block.
using SourceLanes [[gnu::vector_size(width * sizeof(float))]] = float;

// Adds the light of all linked cells times the links' weights, channel by channel.
TROFFER_MULTIVERSION
void add_links(std::span<const CellLink> links, const float* light, float* sum) {
  SourceLanes sums[3];
  std::memcpy(sums, sum, sizeof sums);
  for (const CellLink& k : links) {
    SourceLanes l[3];
    std::memcpy(l, light + size_t(k.cell) * 3 * width, sizeof l);
    sums[0] += k.weight.r * l[0];
    sums[1] += k.weight.g * l[1];
    sums[2] += k.weight.b * l[2];
  }
  std::memcpy(sum, sums, sizeof sums);
}

// The same for links that treat all channels alike, and luminances.
TROFFER_MULTIVERSION
void add_grey_links(std::span<const CellLink> links, const float* light, float* sum) {
  SourceLanes sums;
  std::memcpy(&sums, sum, sizeof sums);
  for (const CellLink& k : links) {
    SourceLanes l;
    std::memcpy(&l, light + size_t(k.cell) * width, sizeof l);
    sums += k.weight.g * l;
  }
  std::memcpy(sum, &sums, sizeof sums);
}

// Replaces the light of a cell, and adds its change and its value to change[0] and change[1].
TROFFER_MULTIVERSION
void replace(const float* light, size_t channels, float* old, float* change) {
  SourceLanes sums[2];
  std::memcpy(sums, change, sizeof sums);
  for (size_t c = 0; c < channels; ++c) {
    SourceLanes from, to;
    std::memcpy(&from, old + c * width, sizeof from);
    std::memcpy(&to, light + c * width, sizeof to);
    const SourceLanes moved = to - from;
    sums[0] += moved < 0 ? -moved : moved;
    sums[1] += to;
    std::memcpy(old + c * width, &to, sizeof to);
  }
  std::memcpy(change, sums, sizeof sums);
}

}  // namespace

BlockSolver::BlockSolver(const TransportCells& cells, const SharedBlockLight& shared,
                         const StateCells* own, const Tracer& tracer, const SourceBlock& block,
                         size_t region)
    : cells_(cells),
      own_(own),
      block_(block),
      channels_((own != nullptr ? own->is_grey() : cells.is_grey()) ? 1 : 3),
      cell_floats_(channels_ * width),
      direct_((cells.cell_count() + (own != nullptr ? own->cell_count() : 0)) * cell_floats_,
              0.0f) {
  light_up(shared, tracer, region);
  if (own_ != nullptr) light_up_own(tracer);
  is_dark_ = std::none_of(direct_.begin(), direct_.end(), [](float d) { return d > 0; });
}

void BlockSolver::solve() {
  if (is_dark_) return;
  total_ = direct_;
  const size_t n = total_.size() / cell_floats_;
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    std::array<float, 2 * width> change{};
    for (size_t k = 0; k < n; ++k) relax(sweep % 2 == 0 ? k : n - 1 - k, change.data());
    const auto sum = [&](size_t first) {
      return std::accumulate(change.begin() + std::ptrdiff_t(first),
                             change.begin() + std::ptrdiff_t(first + width), 0.0);
    };
    if (sum(0) <= most_change * sum(width)) break;
  }
}

void BlockSolver::gather(size_t sensor, std::span<float> coefficients) const {
  LightOfCell sum{};
  if (!is_dark_) add(cells_.sensors().cells.of(sensor), sum.data());
  add_outside(cells_.sensors().outside.of(sensor), sum.data());
  if (own_ != nullptr) {
    if (!is_dark_) add(own_->more_of_sensors().cells.of(sensor), sum.data());
    add_outside(own_->more_of_sensors().outside.of(sensor), sum.data());
  }
  for (size_t i = 0; i < block_.count(); ++i)
    coefficients[block_.number(i)] =
        channels_ == 1 ? sum[i] : luminance({sum[i], sum[width + i], sum[2 * width + i]});
}

// Direct light of shared cells. Rays that meet the state's region are traced in its scene.
void BlockSolver::light_up(const SharedBlockLight& shared, const Tracer& tracer, size_t region) {
  std::vector<uint8_t> is_crossing(shared.crossing().size() + 1, 0);
  OpenRays rays(tracer);
  if (own_ != nullptr) {
    const std::vector<uint32_t>& crossing = shared.crossing_of(region);
    for (const uint32_t i : crossing) {
      is_crossing[i] = 1;
      rays.add(shared.crossing()[i].ray);
    }
    rays.trace();
    for (size_t k = 0; k < crossing.size(); ++k) {
      const SharedBlockLight::CrossingRay& r = shared.crossing()[crossing[k]];
      const Rgb open = rays[k] * r.weight;
      if (!open.is_black()) add(open, r.source, direct_of(r.cell));
    }
    for (size_t c = 0; c < cells_.cell_count(); ++c)
      add_outside(own_->more_of_rows().outside.of(c), direct_of(c));
  }
  for (const SharedCellLight& l : shared.lights())
    if (l.crossing == SharedBlockLight::no_crossing || is_crossing[l.crossing] == 0)
      add(l.light, l.source, direct_of(l.cell));
}

// Direct light of the state's own cells.
void BlockSolver::light_up_own(const Tracer& tracer) {
  struct Sent {
    uint32_t cell, source;
    float weight;
  };
  std::vector<Sent> sent;
  OpenRays rays(tracer);
  const auto receive = [&] {
    rays.trace();
    for (size_t k = 0; k < sent.size(); ++k) {
      const Rgb open = rays[k] * sent[k].weight;
      if (!open.is_black()) add(open, sent[k].source, direct_of(sent[k].cell));
    }
    rays.clear();
    sent.clear();
  };
  const size_t shared = cells_.cell_count();
  for (size_t k = 0; k < own_->cell_count(); ++k) {
    const auto c = uint32_t(shared + k);
    add_outside(own_->rows().outside.of(k), direct_of(c));
    block_.draw(c, k < own_->near_count(), own_->hits(k),
                [&](const CellHit& hit, uint32_t source, const Vec3& direction, float weight,
                    float cosine) {
                  rays.add(hit, direction);
                  sent.push_back({c, source, weight * cosine * own_->coat_factor(hit, cosine)});
                });
    if (rays.size() >= OpenRays::enough) receive();
  }
  receive();
}

void BlockSolver::add(std::span<const CellLink> links, float* sum) const {
  if (!links.empty()) (channels_ == 1 ? add_grey_links : add_links)(links, total_.data(), sum);
}

// Adds light of a source of the block to that of a cell.
void BlockSolver::add(const Rgb& light, size_t source, float* sum) const {
  if (channels_ == 1) {
    sum[source] += luminance(light);
    return;
  }
  for (size_t c = 0; c < 3; ++c) sum[c * width + source] += light[c];
}

void BlockSolver::add_outside(std::span<const OutsideLink> ways, float* sum) const {
  for (const OutsideLink& w : ways)
    for (size_t i = 0; i < block_.count(); ++i)
      if (const float l = block_.radiance(i, w.direction) * pi_f; l > 0) add(w.weight * l, i, sum);
}

// change: sums of changes and of light, for replace().
void BlockSolver::relax(size_t cell, float* change) {
  LightOfCell e;
  std::copy_n(direct_of(cell), cell_floats_, e.begin());
  const size_t shared = cells_.cell_count();
  add(cell < shared ? cells_.rows().cells.of(cell) : own_->rows().cells.of(cell - shared),
      e.data());
  if (own_ != nullptr && cell < shared) add(own_->more_of_rows().cells.of(cell), e.data());
  replace(e.data(), channels_, &total_[cell * cell_floats_], change);
}

}  // namespace troffer
