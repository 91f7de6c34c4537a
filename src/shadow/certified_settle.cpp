// Certificates, masks and rays for one cell of a source: see certified.h.
#include <algorithm>
#include <bit>
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
  if (left.size() > 0 || !is_complete_) return false;
  for (const uint32_t m : members) add_answer(m, 1, 0, ShadowAnswer::lit);
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

// Expected variance of a mask's share. Edges of random directions through a lattice err by 0.07 to
// 0.09 samples squared per boundary pair (docs/certified.md); all samples at the boundary are taken
// to weigh as much as the heaviest, which makes up for edges along the lattice, that err by more.
float mask_variance(const MaskFrame& frame, const MaskWeights& weights, const MaskWeight& sums) {
  if (sums.boundary_pairs == 0) return 0;
  float most = 0;
  for (int i = 0; i < frame.corner_count(); ++i) {
    const MaskFrame::Corner& c = frame.corners()[i];
    most = std::max(most, weight_of(weights, int(c.k), int(c.j)));
  }
  return 0.08f * float(sums.boundary_pairs) * sqr(most / sums.all);
}

}  // namespace

void CertifiedEstimator::mask(std::span<const uint32_t> members, const FacetList& facets) {
  CoverageMask mask;
  float open_by_row[most_mask_rows];
  const ShadowAnswer answer = is_complete_ ? ShadowAnswer::masked : ShadowAnswer::mixed;
  for (const uint32_t m : members) {
    const ShadowReceiver& r = receivers_[m];
    const uint64_t bits = mix64(r.stream + cell_stream_ + 0x5851f42d4c957f2dull);
    const Vec2 shift{unit_float(uint32_t(bits)), unit_float(uint32_t(bits >> 32))};
    ++counters_.masks;
    counters_.mask_facets += facets.size();
    cover(*frame_, facets, frame_->to_canvas(Vec3d(r.origin)), shift, mask);
    if (!mask.is_any_open) {
      add_answer(m, 0, 0, answer);
      continue;
    }
    const Vec3d x(r.position);
    if (has_own_horizons_) clip_to_horizon(*frame_, x, r.horizon, shift, mask);
    const MaskWeights weights = mask_weights(*frame_, x, r.normal, shift);
    const MaskWeight sums = weigh(*frame_, mask, weights, open_by_row);
    if (!(sums.all > 0)) {
      // no sample stands above the horizon: hardly any light can come from here
      add_answer(m, 0.5f, 0.25f, answer);
    } else if (is_complete_ || !(sums.open > 0)) {
      add_answer(m, sums.share(), mask_variance(*frame_, weights, sums), answer);
    } else {
      add_answer(m, 0, mask_variance(*frame_, weights, sums), answer);
      add_rays(m, mask, weights, open_by_row, sums, shift);
    }
  }
}

void CertifiedEstimator::add_rays(uint32_t member, const CoverageMask& mask,
                                  const MaskWeights& weights, const float* open_by_row,
                                  const MaskWeight& sums, const Vec2& shift) {
  SourceVisibility& o = out_[member];
  const ShadowReceiver& r = receivers_[member];
  const float weight = sums.share() * cell_unoccluded_[member];
  const float share = weight / o.unoccluded;
  const float wanted = std::ceil(sqr(0.5f * share / options_.residual_error));
  const auto n = uint32_t(std::clamp(wanted, 1.0f, float(options_.most_rays)));
  // V being 0 or 1, the variance of one ray's answer is at most 1/4
  o.variance += sqr(weight) / (4 * float(n));
  // Systematic sampling: n targets at equal distances over the open weight, one random start.
  const float start = unit_float(uint32_t(mix64(r.stream + cell_stream_ + 0x14057b7ef767814full)));
  // A segment ends target_gap_ before the source's plane, on the line to the sample.
  const Vec3d from(r.origin), first = frame_->first_sample();
  const double height = dot(source_->plane.normal, from - source_->plane.origin);
  const double length = std::max(1 - target_gap_ / height, 0.0);
  uint32_t cast = 0;
  float row_start = 0;
  for (int row = 0; row < frame_->lattice().rows && cast < n; ++row) {
    const float row_end = row_start + open_by_row[row];
    uint32_t bits = mask.open.row[row];
    float passed = row_start;
    int k = -1;
    for (; cast < n; ++cast) {
      const float target = (float(cast) + start) / float(n) * sums.open;
      if (target >= row_end) break;
      while (bits != 0 && passed <= target) {
        k = std::countr_zero(bits);
        passed += weight_of(weights, k, row);
        bits &= bits - 1;
      }
      if (k < 0) break;
      const Vec3d to = first + frame_->step_k() * (double(k) + double(shift.x)) +
                       frame_->step_j() * (double(row) + double(shift.y));
      segments_.push_back({r.origin, Vec3(from + (to - from) * length)});
    }
    row_start = row_end;
  }
  o.rays += cast;
  groups_.push_back({member, cast, weight});
}

void CertifiedEstimator::finish_rays() {
  if (segments_.empty()) return;
  hits_.resize(segments_.size());
  scene_->trace(segments_, hits_);
  size_t i = 0;
  for (const RayGroup& g : groups_) {
    uint32_t hidden = 0;
    for (const size_t end = i + g.count; i < end; ++i) {
      if (hits_[i] == ray_is_free) continue;
      ++hidden;
      if (hits_[i] != ray_is_stopped) found_->add(hits_[i]);
    }
    if (g.count > 0) out_[g.member].visible += g.weight * float(g.count - hidden) / float(g.count);
  }
  found_->trim(options_.most_found);
}

}  // namespace troffer
