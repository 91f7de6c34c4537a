// Certificates, masks and rays for one cell of a source: see certified.h.
#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "shadow/certified.h"

namespace troffer {

size_t CertifiedEstimator::halve_members(std::span<uint32_t> members) const {
  Box box;
  for (const uint32_t m : members) box.grow(receivers_[m].origin);
  const Vec3 e = box.extent();
  const size_t axis = e.x >= e.y && e.x >= e.z ? 0 : e.y >= e.z ? 1 : 2;
  const size_t half = members.size() / 2;
  std::nth_element(members.begin(), members.begin() + std::ptrdiff_t(half), members.end(),
                   [&](uint32_t a, uint32_t b) {
                     const float p = receivers_[a].origin[axis], q = receivers_[b].origin[axis];
                     return p != q ? p < q : a < b;
                   });
  return half;
}

void CertifiedEstimator::add_answer(uint32_t member, float share, float variance,
                                    ShadowAnswer answer) {
  const float weight = cell_unoccluded_[member];
  out_[member].visible += weight * share;
  out_[member].variance += weight * weight * variance;
  cell_sums_[member] += weight;
  kinds_[member] = uint8_t(kinds_[member] | 1u << uint32_t(answer));
}

bool CertifiedEstimator::settle_by_certificate(std::span<const uint32_t> members,
                                               const ReceiverHull& hull, const FacetList& facets,
                                               FacetList& left) {
  left.clear();
  if (facets.size() > 0) {
    MaskPoint corners[8];
    for (int i = 0; i < hull.count; ++i)
      corners[i] = mask_point(*frame_, frame_->to_canvas(hull.corners[size_t(i)]), {0, 0});
    classify(facets, {corners, size_t(hull.count)}, float(hull.slack * frame_->stretch()), flags_);
    const auto hides_all = [](int32_t f) { return f == 2; };
    if (std::any_of(flags_.quads.begin(), flags_.quads.end(), hides_all) ||
        std::any_of(flags_.triangles.begin(), flags_.triangles.end(), hides_all)) {
      for (const uint32_t m : members) add_answer(m, 0, 0, ShadowAnswer::dark);
      return true;
    }
    left.keep_unsettled(facets, flags_);
  }
  if (left.size() > 0 || !is_complete_ || does_horizon_hide_) return false;
  for (const uint32_t m : members) add_lit(m);
  return true;
}

void CertifiedEstimator::settle(std::span<uint32_t> members, const ReceiverHull& hull,
                                const FacetList& facets, int depth) {
  FacetList& left = lists_[size_t(depth) + 1];
  if (settle_by_certificate(members, hull, facets, left)) return;
  if (left.size() < options_.split_above || members.size() < 2 * options_.smallest_cluster ||
      depth >= most_depth)
    return mask(members, left);
  const size_t half = halve_members(members);
  for (const std::span<uint32_t> side : {members.first(half), members.subspan(half)})
    settle(side, hull_of(side), left, depth + 1);
}

namespace {

// Variance of a count of lattice samples behind an edge, in samples squared per pair of neighbours
// that the edge parts: large for edges that run along rows or columns of the lattice, least for
// those along the sides of the source (docs/certified.md). Along diagonals it is large too, but as
// many pairs in rows as in columns mostly mean edges along both sides.
float edge_variance(float least_pairs, float most_pairs) {
  const float ratio = least_pairs / most_pairs;
  // A few pairs do not tell a direction.
  return most_pairs < 6 || ratio > 0.05f ? 0.065f : 0.3f;
}

// Expected variance of a mask's share. Where samples differ from their neighbours as often as if
// they were thrown at random, and not as rarely as in one piece, a pair stands for a quarter of a
// sample squared; samples at the
// boundary are taken to weigh as much as the source's corners, in the root mean square.
float mask_variance(const MaskFrame& frame, const MaskWeights& weights, const MaskWeight& sums) {
  const auto rows = float(sums.row_pairs), columns = float(sums.column_pairs);
  const float pairs = rows + columns;
  if (pairs == 0) return 0;
  float squares = 0;
  for (int i = 0; i < frame.corner_count(); ++i) {
    const MaskFrame::Corner& c = frame.corners()[i];
    squares += sqr(weight_of(weights, int(c.k), int(c.j)));
  }
  // Corners of a disk's square may be far from it.
  const float mean = sums.all / float(frame.lattice().samples());
  const float weight2 = std::min(squares / float(frame.corner_count()), 4 * sqr(mean));
  const auto n = float(frame.lattice().samples());
  const float share = sums.share();
  const float fewest = 4 * std::sqrt(n * std::min(share, 1 - share));  // of a square
  const float random = 4 * n * share * (1 - share);
  const float disorder = std::clamp((pairs - fewest) / std::max(random - fewest, 1.0f), 0.0f, 1.0f);
  const float of_edge = edge_variance(std::min(rows, columns), std::max(rows, columns));
  const float of_pair = of_edge + disorder * std::max(0.25f - of_edge, 0.0f);
  return of_pair * pairs * weight2 / sqr(sums.all);
}

}  // namespace

// Sets samples_ to what a receiver sees of the cell past the facets; the visible share, or -1 where
// no sample stands above the horizon.
float CertifiedEstimator::look(uint32_t member, const FacetList& facets, uint64_t pass,
                               float& variance) {
  const ShadowReceiver& r = receivers_[member];
  const uint64_t bits =
      mix64(r.stream + cell_stream_ + pass * 0x9e3779b97f4a7c15ull + 0x5851f42d4c957f2dull);
  samples_.shift = {unit_float(uint32_t(bits)), unit_float(uint32_t(bits >> 32))};
  cover(*frame_, facets, frame_->to_canvas(Vec3d(r.origin)), samples_.shift, mask_);
  samples_.open = 0;
  variance = 0;
  if (!mask_.is_any_open) return 0;
  const Vec3d x(r.position);
  if (has_own_horizons_) {
    const MaskRows inside = mask_.inside;
    clip_to_horizon(*frame_, x, r.horizon, samples_.shift, mask_);
    if (does_horizon_hide_) mask_.inside = inside;
  }
  samples_.rows = mask_.open;
  samples_.weights = mask_weights(*frame_, x, r.normal, samples_.shift);
  const MaskWeight sums = weigh(*frame_, mask_, samples_.weights, samples_.open_by_row);
  if (!(sums.all > 0)) return -1;
  samples_.open = sums.open;
  variance = mask_variance(*frame_, samples_.weights, sums);
  return sums.share();
}

// Adds the integrand over the samples_ that are open, which send `light`, in sr.
void CertifiedEstimator::add_integral(uint32_t member, float light, float share_variance) {
  const float share = cell_unoccluded_[member] / unoccluded_[member];
  const auto wanted = float(wanted_points_[member]);
  const auto n = uint32_t(std::ceil(std::max(wanted * share, std::min(wanted, 4.0f))));
  const ShadowReceiver& r = receivers_[member];
  const uint64_t bits = mix64(r.stream + cell_stream_ + 0x14057b7ef767814full);
  points_.clear();
  draw_points(*frame_, samples_, n, bits, points_);
  if (points_.empty()) return;
  values_.resize(points_.size());
  terms_.integrand->evaluate(member, points_, values_);
  if (!is_complete_) return rays_.add(member, r.origin, points_, values_, light);
  Rgb sum;
  float squares = 0;
  for (const Rgb& v : values_) {
    sum += v;
    squares += sqr(luminance(v));
  }
  const auto count = float(points_.size());
  const float mean = luminance(sum) / count;
  SourceVisibility& o = out_[member];
  o.value += sum * (light / count);
  o.value_variance += share_variance * sqr(cell_unoccluded_[member] * mean) +
                      sqr(light) * std::max(squares - sqr(mean) * count, 0.0f) /
                          (count * std::max(count - 1, 1.0f));
}

void CertifiedEstimator::add_lit(uint32_t member) {
  add_answer(member, 1, 0, ShadowAnswer::lit);
  if (wanted_points_[member] == 0) return;
  float variance = 0;
  static const FacetList nothing;
  if (look(member, nothing, 0, variance) > 0) add_integral(member, cell_unoccluded_[member], 0);
}

void CertifiedEstimator::mask(std::span<const uint32_t> members, const FacetList& facets) {
  if (!is_complete_ && found_->is_hopeless) return mask_often(members, facets);
  const ShadowAnswer answer = is_complete_ ? ShadowAnswer::masked : ShadowAnswer::mixed;
  for (const uint32_t m : members) {
    ++counters_.masks;
    counters_.mask_facets += facets.size();
    float variance = 0;
    const float share = look(m, facets, 0, variance);
    const float light = share * cell_unoccluded_[m];
    if (share < 0) {
      add_answer(m, 0.5f, 0.25f, answer);  // hardly any light can come from here
    } else if (is_complete_ || !(share > 0)) {
      add_answer(m, share, variance, answer);
      if (share > 0 && wanted_points_[m] > 0) add_integral(m, light, variance);
    } else {
      add_answer(m, 0, variance, answer);
      if (wanted_points_[m] > 0)
        add_integral(m, light, variance);
      else
        rays_.add(m, receivers_[m].origin, samples_, light, unoccluded_[m], ray_numbers(m, 0));
    }
  }
}

uint64_t CertifiedEstimator::ray_numbers(uint32_t member, uint64_t pass) const {
  return mix64(receivers_[member].stream + cell_stream_ + pass * 0x9e3779b97f4a7c15ull +
               0x14057b7ef767814full);
}

// Where much is left to rays, they must not go through the same few hundred points over and over:
// masks with several shifts share them.
void CertifiedEstimator::mask_often(std::span<const uint32_t> members, const FacetList& facets) {
  for (const uint32_t m : members) {
    // An integrand has a number of points of its own; one mask, and its answer stands even if it
    // finds nothing open.
    const uint32_t passes = wanted_points_[m] > 0 ? 1 : options_.masks_with_rays;
    bool is_above = false;
    for (uint32_t pass = 0; pass < passes; ++pass) {
      ++counters_.masks;
      counters_.mask_facets += facets.size();
      float variance = 0;
      const float share = look(m, facets, pass, variance);
      is_above = is_above || share >= 0;
      if (!(share > 0)) continue;
      if (wanted_points_[m] > 0)
        add_integral(m, share * cell_unoccluded_[m], variance);
      else
        rays_.add(m, receivers_[m].origin, samples_, share * cell_unoccluded_[m] / float(passes),
                  unoccluded_[m], ray_numbers(m, pass), passes);
    }
    add_answer(m, is_above ? 0.0f : 0.5f, is_above ? 0.0f : 0.25f, ShadowAnswer::mixed);
  }
}

}  // namespace troffer
