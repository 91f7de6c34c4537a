#include "shadow/mask_cell.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "base/streams.h"
#include "shadow/mask_variance.h"
#include "shadow/round_cover.h"

namespace troffer {

namespace {

// Random numbers of a pair of receiver and cell, distinct for each purpose and pass.
uint64_t numbers_of(const SourceCellTask& cell, uint32_t member, uint64_t pass, uint64_t purpose) {
  return mix64(cell.receiver(member).stream + cell.stream + pass * 0x9e3779b97f4a7c15ull + purpose);
}

void add_answer(const SourceCellTask& cell, uint32_t member, const MaskShare& share,
                ShadowAnswer kind, SourceResults& results) {
  results.sums[member].add(cell.unoccluded[member], share.share, share.variance, kind);
}

// True if all samples lie above the receiver's horizon.
bool is_above_horizon(const MaskFrame& frame, const MaskWeights& w) {
  const auto last = float(frame.lattice().rows);
  return w.cosine + std::min(w.cosine_j, 0.0f) * last + std::min(w.cosine_k, 0.0f) * last > 0;
}

// Answer for cells without a sample above the horizon. Hardly any light can come from there.
constexpr MaskShare unknown_share{0.5f, 0.25f};

}  // namespace

MaskShare mask_share_of(const SourceCellTask& cell, uint32_t member, const FacetList& facets,
                        uint64_t pass, MaskMemory& memory) {
  const MaskFrame& frame = cell.frame;
  const ShadowReceiver& r = cell.receiver(member);
  CoverageMask& mask = memory.mask;
  OpenSamples& samples = memory.samples;
  const uint64_t bits = numbers_of(cell, member, pass, stream::mask_shift);
  samples.shift = {unit_float(uint32_t(bits)), unit_float(uint32_t(bits >> 32))};
  cover(frame, facets, frame.to_canvas(Vec3d(r.origin)), samples.shift, mask);
  cover(frame, facets.round(), Vec3d(r.origin), samples.shift, mask);
  samples.open = 0;
  if (!mask.is_any_open) return {0, 0};
  const Vec3d x(r.position);
  if (cell.source.cluster.has_own_horizons) {
    const MaskRows inside = mask.inside;
    clip_to_horizon(frame, x, r.horizon, samples.shift, mask);
    if (cell.source.does_horizon_hide()) mask.inside = inside;
  }
  samples.weights = mask_weights(frame, x, r.normal, samples.shift);
  const bool is_above = is_above_horizon(frame, samples.weights);
  if (!is_above) clip_to_horizon(frame, x, r.normal, samples.shift, mask);
  samples.rows = mask.open;
  // Without an integrand, weights do not matter if all samples are open.
  const bool is_answer = cell.is_complete && cell.source.wanted_points[member] == 0;
  if (is_answer && is_above &&
      std::equal(mask.open.row, mask.open.row + most_mask_rows, mask.inside.row))
    return {1, 0};
  const MaskWeight sums = weigh(frame, mask, samples.weights, samples.open_by_row);
  if (!(sums.all > 0)) return {-1, 0};
  samples.open = sums.open;
  return {sums.share(), mask_variance(frame, sums, mask, samples.weights, facets.edges_along())};
}

namespace {

// Adds the integrand over the open samples, which send `light` sr. With an incomplete list it
// queues rays.
void add_integral(const SourceCellTask& cell, uint32_t member, float light, float share_variance,
                  MaskMemory& memory, SourceResults& results) {
  const SourceTask& source = cell.source;
  const float share = cell.unoccluded[member] / source.unoccluded[member];
  const auto wanted = float(source.wanted_points[member]);
  const auto n = uint32_t(std::ceil(std::max(wanted * share, std::min(wanted, 4.0f))));
  if (source.integrand->is_smooth(source.number, member))
    return add_lattice_integral(cell, member, memory.samples, light, share_variance, n,
                                numbers_of(cell, member, 0, stream::mask_points), memory.lattice,
                                results);
  memory.points.clear();
  draw_points(cell.frame, memory.samples, n, numbers_of(cell, member, 0, stream::mask_points),
              memory.points);
  if (memory.points.empty()) return;
  memory.values.resize(memory.points.size());
  source.integrand->evaluate(source.number, member, memory.points, memory.values);
  if (!cell.is_complete)
    return results.rays.add(member, cell.receiver(member).origin, memory.points, memory.values,
                            light);
  Rgb sum;
  float squares = 0;
  for (const Rgb& v : memory.values) {
    sum += v;
    squares += sqr(luminance(v));
  }
  const auto count = float(memory.points.size());
  const float mean = luminance(sum) / count;
  CellSum& o = results.sums[member];
  o.value += sum * (light / count);
  o.value_variance += share_variance * sqr(cell.unoccluded[member] * mean) +
                      sqr(light) * std::max(squares - sqr(mean) * count, 0.0f) /
                          (count * std::max(count - 1, 1.0f));
}

// Queues rays through the open samples.
void queue_samples(const SourceCellTask& cell, uint32_t member, float light, uint32_t pass,
                   uint32_t passes, const MaskMemory& memory, SourceResults& results) {
  results.rays.add(member, cell.receiver(member).origin, memory.samples, light,
                   cell.source.unoccluded[member],
                   numbers_of(cell, member, pass, stream::mask_points), passes);
}

MaskShare counted_mask(const SourceCellTask& cell, uint32_t member, const FacetList& facets,
                       uint64_t pass, MaskMemory& memory, SourceResults& results) {
  ++results.counters.masks;
  results.counters.mask_facets += facets.size();
  return mask_share_of(cell, member, facets, pass, memory);
}

void mask_complete(const SourceCellTask& cell, uint32_t member, const FacetList& facets,
                   MaskMemory& memory, SourceResults& results) {
  const MaskShare seen = counted_mask(cell, member, facets, 0, memory, results);
  add_answer(cell, member, seen.share < 0 ? unknown_share : seen, ShadowAnswer::masked, results);
  if (seen.share > 0 && cell.source.wanted_points[member] > 0)
    add_integral(cell, member, seen.share * cell.unoccluded[member], seen.variance, memory,
                 results);
}

// Splits the open samples by cell.masked: those that nothing else can hide become `free`, and
// memory.samples keeps those that only rays can decide. Returns the free share of the open weight.
float divide_open(const SourceCellTask& cell, uint32_t member, MaskMemory& memory,
                  OpenSamples& free) {
  const MaskFrame& frame = cell.frame;
  OpenSamples& rest = memory.samples;
  const float open = rest.open;
  cover(frame, *cell.masked, frame.to_canvas(Vec3d(cell.receiver(member).origin)), rest.shift,
        memory.mask);
  free = rest;
  CoverageMask part = memory.mask;
  const auto set = [&](OpenSamples& s) {
    part.open = s.rows;
    s.open = weigh(frame, part, s.weights, s.open_by_row).open;
  };
  for (size_t r = 0; r < most_mask_rows; ++r) {
    free.rows.row[r] &= memory.mask.open.row[r];
    rest.rows.row[r] &= ~memory.mask.open.row[r];
  }
  set(free);
  set(rest);
  return std::clamp(free.open / open, 0.0f, 1.0f);
}

// Masks a receiver with an incomplete list. Samples that the mask finds dark are dark, and samples
// clear of cell.masked are open. Rays decide the others.
void mask_incomplete(const SourceCellTask& cell, uint32_t member, const FacetList& facets,
                     MaskMemory& memory, SourceResults& results) {
  const MaskShare seen = counted_mask(cell, member, facets, 0, memory, results);
  float free_share = 0;
  if (seen.share > 0 && cell.masked != nullptr) {
    OpenSamples free;
    free_share = seen.share * divide_open(cell, member, memory, free);
    if (free_share > 0 && cell.source.wanted_points[member] > 0) {
      std::swap(free, memory.samples);
      SourceCellTask complete = cell;
      complete.is_complete = true;
      add_integral(complete, member, free_share * cell.unoccluded[member], seen.variance, memory,
                   results);
      std::swap(free, memory.samples);
    }
  }
  const bool is_any_left = seen.share > 0 && memory.samples.open > 0;
  add_answer(cell, member, seen.share < 0 ? unknown_share : MaskShare{free_share, seen.variance},
             is_any_left || seen.share < 0 ? ShadowAnswer::mixed : ShadowAnswer::masked, results);
  if (!is_any_left) return;
  const float light = std::max(seen.share - free_share, 0.0f) * cell.unoccluded[member];
  if (cell.source.wanted_points[member] > 0)
    add_integral(cell, member, light, seen.variance, memory, results);
  else
    queue_samples(cell, member, light, 0, 1, memory, results);
}

// Masks a receiver whose list is over budget. Several masks with different shifts share its many
// rays, so that these do not repeat the same few hundred points. An integrand has its own number of
// points and gets one mask, whose answer counts even if it finds nothing open.
void mask_over_budget(const SourceCellTask& cell, uint32_t member, const FacetList& facets,
                      MaskMemory& memory, SourceResults& results) {
  const bool has_integrand = cell.source.wanted_points[member] > 0;
  const uint32_t passes = has_integrand ? 1 : cell.source.options.masks_with_rays;
  bool is_above = false;
  for (uint32_t pass = 0; pass < passes; ++pass) {
    const MaskShare seen = counted_mask(cell, member, facets, pass, memory, results);
    is_above = is_above || seen.share >= 0;
    if (!(seen.share > 0)) continue;
    const float light = seen.share * cell.unoccluded[member];
    if (has_integrand)
      add_integral(cell, member, light, seen.variance, memory, results);
    else
      queue_samples(cell, member, light / float(passes), pass, passes, memory, results);
  }
  add_answer(cell, member, is_above ? MaskShare{0, 0} : unknown_share, ShadowAnswer::mixed,
             results);
}

}  // namespace

void add_lit(const SourceCellTask& cell, uint32_t member, MaskMemory& memory,
             SourceResults& results) {
  add_answer(cell, member, {1, 0}, ShadowAnswer::lit, results);
  if (cell.source.wanted_points[member] == 0) return;
  static const FacetList nothing;
  if (mask_share_of(cell, member, nothing, 0, memory).share > 0)
    add_integral(cell, member, cell.unoccluded[member], 0, memory, results);
}

void mask_cell(const SourceCellTask& cell, std::span<const uint32_t> members,
               const FacetList& facets, MaskMemory& memory, SourceResults& results) {
  const auto mask =
      cell.is_complete ? mask_complete : (cell.is_over_budget ? mask_over_budget : mask_incomplete);
  for (const uint32_t m : members) mask(cell, m, facets, memory, results);
}

}  // namespace troffer
