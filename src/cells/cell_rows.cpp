#include "cells/cell_rows.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/random.h"
#include "base/streams.h"
#include "base/vec.h"
#include "cells/balance_solver.h"

namespace troffer {

namespace {

constexpr size_t rows_at_a_time = 1024;
constexpr int most_iterations = 400;
constexpr int bounces_of_noise = 6;
// Largest factor by which a row may pass on light: for few rays, and for more.
constexpr float most_by_few = 0.99f, most_by_more = 1.2f;
constexpr uint32_t few_rays = 8;
constexpr double most_unbalanced = 2e-6;  // residual over light, both by importance
// Limit of importance, which rows made by rays do not reach. Those of a file may amplify it to
// infinity.
constexpr float most_importance = 1e30f;

template <typename F>
void by_cells(size_t n, int threads, const F& f) {
  parallel_for((n + rows_at_a_time - 1) / rows_at_a_time, threads, [&](size_t chunk) {
    const size_t end = std::min(n, (chunk + 1) * rows_at_a_time);
    for (size_t i = chunk * rows_at_a_time; i < end; ++i) f(i);
  });
}

}  // namespace

void CellRows::add(const RowPart& part, std::span<const RowEntry> entries) {
  first_entry_.push_back(entries_.size());
  parts_.push_back(part);
  parts_.back().entries = uint32_t(entries.size());
  entries_.insert(entries_.end(), entries.begin(), entries.end());
  rays_in_all_ += part.rays;
}

void CellRows::finish(size_t cells) {
  rays_.assign(cells, 0);
  begin_.assign(cells + 1, 0);
  for (const RowPart& p : parts_) {
    rays_[p.cell] += p.rays;
    ++begin_[p.cell + 1];
  }
  for (size_t i = 0; i < cells; ++i) begin_[i + 1] += begin_[i];
  order_.resize(parts_.size());
  std::vector<size_t> next(begin_.begin(), begin_.end() - 1);
  for (uint32_t p = 0; p < parts_.size(); ++p) order_[next[parts_[p].cell]++] = p;
  share_.resize(cells);
  for (size_t i = 0; i < cells; ++i) share_[i] = bounded_share(i);
}

// Returns the factor on a row's weights, bounded so that the row does not amplify light. With few
// rays the sum of the weights can exceed 1 by chance. Cells that see only themselves or each other
// would then amplify light at every bounce, and the iteration would diverge or end far too bright.
// Rows of many rays have a looser bound, because their sums vary less and average out between
// neighbours. Measured: with the strict bound for all rows, a white kitchen lacks .4 % of its
// reflected light.
float CellRows::bounded_share(size_t cell) const {
  if (rays_[cell] == 0) return 1;
  Rgb sum;
  for (size_t o = begin_[cell]; o < begin_[cell + 1]; ++o)
    for (const RowEntry& k : entries(order_[o])) sum += k.weight;
  const float most = rays_[cell] < few_rays ? most_by_few : most_by_more;
  return std::min(1 / float(rays_[cell]), most / std::max(max_component(sum), 1e-30f));
}

CellRows::RowSum CellRows::sum_of(size_t cell, const std::vector<Rgb>& e, Half half) const {
  RowSum sum;
  for (size_t o = begin_[cell]; o < begin_[cell + 1]; ++o) {
    const RowPart& p = parts_[order_[o]];
    if (p.is_second_half != (half == Half::second)) continue;
    sum.emitted += p.emission;
    sum.rays += p.rays;
    for (const RowEntry& k : entries(order_[o])) sum.reflected += k.weight * e[k.cell];
  }
  return sum;
}

// Returns, per cell, D and the light of sources that its rays ran into.
std::vector<Rgb> CellRows::light_of_sources(const std::vector<Rgb>& direct, int threads) const {
  std::vector<Rgb> out = direct;
  by_cells(direct.size(), threads, [&](size_t i) {
    Rgb emitted;
    for (size_t o = begin_[i]; o < begin_[i + 1]; ++o) emitted += parts_[order_[o]].emission;
    if (rays_[i] > 0) out[i] += emitted / float(rays_[i]);
  });
  return out;
}

CellRows::Packed CellRows::packed() const {
  Packed rows;
  rows.begin.reserve(rays_.size() + 1);
  rows.begin.push_back(0);
  rows.entries.reserve(entries_.size());
  for (size_t i = 0; i < rays_.size(); ++i) {
    const float share = share_[i];
    for (size_t o = begin_[i]; o < begin_[i + 1]; ++o)
      for (const RowEntry& k : entries(order_[o]))
        rows.entries.push_back({k.cell, k.weight * share});
    rows.begin.push_back(rows.entries.size());
  }
  return rows;
}

// Half the difference of what the two halves of a cell's rays bring: one draw of the error of their
// mean. A single ray does not tell how far others would be from it. Its error is taken to be half
// of what it brings, with a random sign, because equal signs would add up.
float CellRows::difference_of_halves(size_t cell, const std::vector<Rgb>& e) const {
  float mean[2];
  int halves = 0;
  for (const Half half : {Half::first, Half::second}) {
    const RowSum sum = sum_of(cell, e, half);
    if (sum.rays > 0) mean[halves++] = luminance(sum.emitted + sum.reflected) / float(sum.rays);
  }
  if (halves == 2) return 0.5f * (mean[0] - mean[1]);
  if (halves == 0) return 0;
  return (mix64(cell) & 1) != 0 ? 0.5f * mean[0] : -0.5f * mean[0];
}

std::vector<float> CellRows::differences(const std::vector<Rgb>& e, int threads) const {
  std::vector<float> own(e.size());
  by_cells(e.size(), threads, [&](size_t i) { own[i] = difference_of_halves(i, e); });
  return own;
}

// All draws go together, because finding the cells of a row in memory takes longer than adding.
std::vector<NoiseDraws> CellRows::noise_draws(const std::vector<float>& by_rows,
                                              const std::vector<float>& by_hits, uint64_t seed,
                                              int threads) const {
  const Packed rows = packed();
  std::vector<NoiseDraws> source(by_rows.size()), draws, next(by_rows.size());
  by_cells(source.size(), threads, [&](size_t i) {
    uint64_t signs = hash_of(seed, i, stream::noise_signs);
    for (float& d : source[i]) {
      d = ((signs & 1) != 0 ? by_rows[i] : -by_rows[i]) +
          ((signs & 2) != 0 ? by_hits[i] : -by_hits[i]);
      signs >>= 2;
    }
  });
  static_assert(2 * draws_of_noise <= 64);
  draws = source;
  for (int bounce = 0; bounce < bounces_of_noise; ++bounce) {
    by_cells(source.size(), threads, [&](size_t i) {
      next[i] = source[i];
      for (const RowEntry& k : rows.of(i)) add_draws(next[i], luminance(k.weight), draws[k.cell]);
    });
    draws.swap(next);
  }
  return draws;
}

// Propagates errors to cells that see a cell: d = s + W d, over the first few bounces.
void CellRows::spread(const Packed& rows, std::vector<float>& differences, int threads) {
  const std::vector<float> source = differences;
  std::vector<float> next(source.size());
  for (int bounce = 0; bounce < bounces_of_noise; ++bounce) {
    by_cells(source.size(), threads, [&](size_t i) {
      next[i] = source[i];
      for (const RowEntry& k : rows.of(i)) next[i] += luminance(k.weight) * differences[k.cell];
    });
    differences.swap(next);
  }
}

CellLight CellRows::solve(const std::vector<Rgb>& direct, const std::vector<float>& of_direct,
                          std::vector<float> importance, int threads) const {
  importance.resize(direct.size(), 0);
  CellLight light;
  const std::vector<Rgb> given = light_of_sources(direct, threads);
  const Packed rows = packed();
  const LightOperator reflected = [&](const std::vector<Rgb>& v, std::vector<Rgb>& out) {
    out.resize(v.size());
    by_cells(v.size(), threads, [&](size_t i) {
      Rgb sum;
      for (const RowEntry& k : rows.of(i)) sum += k.weight * v[k.cell];
      out[i] = sum;
    });
  };
  Balance balance =
      solve_balance(reflected, given, importance, most_unbalanced, most_iterations, threads);
  light.iterations = balance.iterations;
  std::vector<Rgb> e = std::move(balance.light);
  for (Rgb& x : e) x = {std::max(x.r, 0.0f), std::max(x.g, 0.0f), std::max(x.b, 0.0f)};
  light.half_difference = of_direct;
  const std::vector<float> own = differences(e, threads);
  for (size_t i = 0; i < own.size(); ++i) light.half_difference[i] += own[i];
  spread(rows, light.half_difference, threads);
  light.irradiance = std::move(e);
  return light;
}

std::vector<float> CellRows::importance(const std::vector<float>& asked, std::vector<float> known,
                                        int iterations) const {
  // `wave` is the residual of y: c + Wᵀ y - y at first, then Wᵀ wave, bounce after bounce.
  std::vector<float> y = asked, wave = asked, next(asked.size());
  const auto pass_on = [&] {
    std::fill(next.begin(), next.end(), 0.0f);
    for (size_t p = 0; p < parts_.size(); ++p) {
      const float given = wave[parts_[p].cell];
      if (given == 0) continue;
      const float each = given * share_[parts_[p].cell];
      for (const RowEntry& k : entries(p)) next[k.cell] += each * luminance(k.weight);
    }
    wave.swap(next);
  };
  const auto is_bounded = [&] {
    return std::all_of(wave.begin(), wave.end(),
                       [](float w) { return std::abs(w) <= most_importance; });
  };
  if (!known.empty()) {
    known.resize(asked.size(), 0);
    wave = known;
    pass_on();
    for (size_t i = 0; i < y.size(); ++i) wave[i] += asked[i] - known[i];
    y = std::move(known);
    if (!is_bounded()) return y;
    for (size_t i = 0; i < y.size(); ++i) y[i] += wave[i];
  }
  for (int it = 0; it < iterations; ++it) {
    pass_on();
    if (!is_bounded()) break;
    double sum = 0, all = 0;
    for (size_t i = 0; i < y.size(); ++i) {
      y[i] += wave[i];
      sum += std::abs(double(wave[i]));
      all += double(y[i]);
    }
    if (sum <= 1e-4 * all) break;
  }
  for (float& v : y) v = std::max(v, 0.0f);
  return y;
}

}  // namespace troffer
