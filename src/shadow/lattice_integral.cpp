#include "shadow/lattice_integral.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/random.h"

namespace troffer {

namespace {

// Lattices with more samples are evaluated at every other row and column. The offset is random, so
// each sample is equally likely.
constexpr int most_samples = 256;
// For low-variance integrands every fourth row and column is enough. At least this many samples
// must be open there, for the fine and for the coarse lattice.
constexpr size_t low_variance_samples = 16, coarse_low_variance_samples = 8;

// Sets points, weights and places to the open samples of every stride-th row and column.
void set_points(const SourceCellTask& cell, uint32_t member, const OpenSamples& s, int stride,
                uint64_t random, LatticeMemory& m) {
  const MaskFrame& frame = cell.frame;
  const Vec3d step_k = frame.step_k(), step_j = frame.step_j();
  const Vec3d from = frame.first_sample() + step_k * double(s.shift.x) +
                     step_j * double(s.shift.y) - Vec3d(cell.receiver(member).position);
  const Vec3 first(from), k_step(step_k), j_step(step_j);
  m.points.clear();
  m.weights.clear();
  m.places.clear();
  constexpr uint32_t every_fourth = 0x11111111u;
  const int row_of = int(random & uint64_t(stride - 1));
  const auto column = uint32_t(random >> 8) & uint32_t(stride - 1);
  const uint32_t columns = stride == 1   ? ~0u
                           : stride == 2 ? (every_fourth | every_fourth << 2) << column
                                         : every_fourth << column;
  for (int j = row_of; j < frame.lattice().rows; j += stride) {
    const Vec3 row = first + j_step * float(j);
    for (uint32_t bits = s.rows.row[j] & columns; bits != 0; bits &= bits - 1) {
      const int k = std::countr_zero(bits);
      const float weight = weight_of(s.weights, k, j);
      if (!(weight > 0)) continue;
      m.points.x.push_back(row.x + k_step.x * float(k));
      m.points.y.push_back(row.y + k_step.y * float(k));
      m.points.z.push_back(row.z + k_step.z * float(k));
      m.weights.push_back(weight);
      m.places.push_back(uint16_t(j * 32 + k));
    }
  }
}

struct LatticeSum {
  double weight = 0, r = 0, g = 0, b = 0;
  // of the four sublattices of every other row and column: weights, and luminance times weight
  double part_weights[4] = {}, parts[4] = {};
  double squares = 0;  // sum of squares of weight × second difference along a row

  Rgb mean() const { return Rgb{float(r), float(g), float(b)} * float(1 / weight); }
  double variance_of_mean() const;
};

// Estimates the variance from the four sublattices. For a slope of s per step they differ as much
// as the mean does by the lattice's position (s² / 12). For independent noise they differ as
// samples do. A function that bends evenly over some steps is integrated well, and they differ
// little.
double LatticeSum::variance_of_mean() const {
  const double mean = (0.2126 * r + 0.7152 * g + 0.0722 * b) / weight;
  double sum = 0;
  for (int i = 0; i < 4; ++i) {
    // second differences of noise have six times its variance
    if (!(part_weights[i] > 0)) return squares / (6 * sqr(weight));
    sum += sqr((parts[i] - part_weights[i] * mean) / weight);
  }
  return sum * 4 / 3;
}

LatticeSum sum_of(const LatticeMemory& m, int stride) {
  LatticeSum s;
  const PointArrays& p = m.points;
  const auto value = [&](size_t i) { return luminance(Rgb{p.r[i], p.g[i], p.b[i]}); };
  for (size_t i = 0; i < p.size(); ++i) {
    const auto w = double(m.weights[i]);
    s.weight += w;
    s.r += w * double(p.r[i]);
    s.g += w * double(p.g[i]);
    s.b += w * double(p.b[i]);
    const int part = (m.places[i] % 32 / stride & 1) + 2 * (m.places[i] / 32 / stride & 1);
    s.part_weights[part] += w;
    s.parts[part] += w * double(value(i));
    if (i == 0 || i + 1 == p.size() || m.places[i + 1] / 32 != m.places[i - 1] / 32) continue;
    s.squares += sqr(w * double(value(i - 1) - 2 * value(i) + value(i + 1)));
  }
  return s;
}

// Draws points in proportion to weight, one from each of n equal parts, into memory.drawn and
// memory.values. Returns the mean of the values.
Rgb draw(const SourceCellTask& cell, const OpenSamples& s, const LatticeSum& sum, uint32_t n,
         uint64_t random, LatticeMemory& m) {
  const MaskFrame& frame = cell.frame;
  const Vec3d first = frame.first_sample() + frame.step_k() * double(s.shift.x) +
                      frame.step_j() * double(s.shift.y);
  m.drawn.clear();
  m.values.clear();
  Rgb total;
  double passed = double(m.weights[0]);
  size_t at = 0;
  for (uint32_t i = 0; i < n; ++i) {
    const double u = double(unit_float(uint32_t(mix64(random + i) >> 32)));
    const double target = (double(i) + u) / n * sum.weight;
    while (passed <= target && at + 1 < m.weights.size()) passed += double(m.weights[++at]);
    const int j = m.places[at] / 32, k = m.places[at] % 32;
    m.drawn.emplace_back(first + frame.step_k() * double(k) + frame.step_j() * double(j));
    m.values.push_back({m.points.r[at], m.points.g[at], m.points.b[at]});
    total += m.values.back();
  }
  return total * (1 / float(n));
}

}  // namespace

void add_lattice_integral(const SourceCellTask& cell, uint32_t member, const OpenSamples& samples,
                          float light, float share_variance, uint32_t rays, uint64_t random,
                          LatticeMemory& m, SourceResults& results) {
  const bool is_fine = cell.frame.lattice().samples() > most_samples;
  const bool is_low_variance = cell.source.integrand->is_low_variance(cell.source.number, member);
  const size_t fewest =
      is_low_variance ? (is_fine ? low_variance_samples : coarse_low_variance_samples) : 1;
  int stride = is_low_variance ? 4 : is_fine ? 2 : 1;
  set_points(cell, member, samples, stride, random, m);
  if (is_low_variance && m.weights.size() < fewest)
    set_points(cell, member, samples, stride = is_fine ? 2 : 1, random, m);
  if (m.weights.empty()) set_points(cell, member, samples, stride = 1, random, m);
  if (m.weights.empty()) return;
  cell.source.integrand->evaluate_many(cell.source.number, member, m.points);
  results.counters.points += m.weights.size();
  const LatticeSum sum = sum_of(m, stride);
  const Rgb mean = sum.mean();
  CellSum& o = results.sums[member];
  o.value += mean * light;
  o.value_variance += share_variance * sqr(cell.unoccluded[member] * luminance(mean)) +
                      sqr(light) * float(sum.variance_of_mean());
  if (cell.is_complete) return;
  o.value += draw(cell, samples, sum, rays, mix64(random), m) * -light;
  results.rays.add(member, cell.receiver(member).origin, m.drawn, m.values, light, true);
}

}  // namespace troffer
