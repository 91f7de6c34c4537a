#include "shadow/certified.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/random.h"
#include "shadow/certified_irradiance.h"

namespace troffer {

std::vector<Vec3d> FlatSource::corners() const {
  const auto at = [&](double u, double v) { return plane.origin + plane.u * u + plane.v * v; };
  if (outline.empty()) return {at(0, 0), at(1, 0), at(1, 1), at(0, 1)};
  std::vector<Vec3d> c;
  for (const Vec2& p : outline) c.push_back(at(double(p.x), double(p.y)));
  return c;
}

void FoundFacets::add(uint32_t id) {
  for (Entry& e : entries_)
    if (e.id == id) {
      ++e.hits;
      return;
    }
  entries_.push_back({id, 1});
}

void FoundFacets::trim(size_t most) {
  std::stable_sort(entries_.begin(), entries_.end(),
                   [](const Entry& a, const Entry& b) { return a.hits > b.hits; });
  if (entries_.size() > most) entries_.resize(most);
  for (Entry& e : entries_) e.hits = (e.hits + 1) / 2;
}

ReceiverHull CertifiedEstimator::hull_of(std::span<const uint32_t> members) {
  hull_origins_.clear();
  hull_normals_.clear();
  for (const uint32_t m : members) {
    hull_origins_.push_back(receivers_[m].origin);
    hull_normals_.push_back(receivers_[m].normal);
  }
  return bound_receivers(hull_origins_, hull_normals_);
}

void CertifiedEstimator::evaluate(const FlatSource& source,
                                  std::span<const ShadowReceiver> receivers, ShadowScene& scene,
                                  FoundFacets& found, std::span<SourceVisibility> out) {
  ++counters_.clusters;
  source_ = &source;
  scene_ = &scene;
  receivers_ = receivers;
  out_ = out;
  const std::vector<Vec3d> outline = source.corners();
  positions_.resize(receivers.size());
  normals_.resize(receivers.size());
  unoccluded_.resize(receivers.size());
  for (size_t i = 0; i < receivers.size(); ++i) {
    positions_[i] = receivers[i].position;
    normals_[i] = receivers[i].normal;
  }
  unoccluded_irradiance(outline, source.plane.normal, receivers.size(), positions_.data(),
                        normals_.data(), unoccluded_.data());
  members_.clear();
  for (uint32_t i = 0; i < receivers.size(); ++i) {
    out[i] = {unoccluded_[i], 0, 0, 0, ShadowAnswer::below};
    if (unoccluded_[i] > 0) members_.push_back(i);
  }
  if (members_.empty()) return;

  const ReceiverHull hull = hull_of(members_);
  const Shaft shaft = make_shaft(hull, outline, source.plane.normal, scene.magnitude());
  Box receiver_box, source_box;
  for (int i = 0; i < hull.count; ++i) receiver_box.grow(Vec3(hull.corners[size_t(i)]));
  double magnitude = hull.magnitude;
  for (const Vec3d& c : outline) {
    source_box.grow(Vec3(c));
    magnitude = std::max({magnitude, std::abs(c.x), std::abs(c.y), std::abs(c.z)});
  }
  target_gap_ = 8e-6 * magnitude;
  ++counters_.gathers;
  scene.candidates(shaft.all(), receiver_box, source_box, options_.longest_list, candidates_);
  is_complete_ = candidates_.is_complete;
  counters_.candidates += candidates_.facets.size();
  if (!is_complete_) ++counters_.incomplete;

  const uint64_t cluster_stream = receivers[members_[0]].stream;
  const MaskFrame frame(source.plane, options_.lattice, (mix64(cluster_stream) & 1) != 0,
                        hull.centre, source.outline);
  frame_ = &frame;
  FacetList& facets = lists_[0];
  facets.clear();
  for (const ShadowCandidate& c : candidates_.facets) facets.add(frame, c.quad, c.is_front_only);
  if (!is_complete_) {
    for (const FoundFacets::Entry& e : found.entries()) {
      const bool is_known = std::any_of(candidates_.facets.begin(), candidates_.facets.end(),
                                        [&](const ShadowCandidate& c) { return c.id == e.id; });
      if (!is_known) facets.add(frame, scene.facet(e.id));
    }
  }
  facets.finish();
  segments_.clear();
  ray_receivers_.clear();
  settle(members_, facets, 0);
  finish_rays(found);
}

bool CertifiedEstimator::settle_by_certificate(std::span<const uint32_t> members,
                                               const ReceiverHull& hull, const FacetList& facets,
                                               FacetList& left) {
  MaskPoint corners[8];
  float slack = 0;
  for (int i = 0; i < hull.count; ++i)
    corners[i] = mask_point(*frame_, frame_->to_canvas(hull.corners[size_t(i)]), {0, 0});
  // canvas units per metre are at most this
  const double stretch = double(frame_->lattice().samples()) *
                         (1 / length(source_->plane.u) + 1 / length(source_->plane.v));
  slack = float(hull.slack * stretch);
  classify(facets, {corners, size_t(hull.count)}, slack, flags_);
  const auto is_cover = [](int32_t f) { return f == 2; };
  const bool is_dark = std::any_of(flags_.quads.begin(), flags_.quads.end(), is_cover) ||
                       std::any_of(flags_.triangles.begin(), flags_.triangles.end(), is_cover);
  if (is_dark) {
    for (const uint32_t m : members) out_[m].answer = ShadowAnswer::dark;
    return true;
  }
  left.keep_unsettled(facets, flags_);
  if (left.size() == 0 && is_complete_) {
    for (const uint32_t m : members) {
      out_[m].visible = 1;
      out_[m].answer = ShadowAnswer::lit;
    }
    return true;
  }
  return false;
}

void CertifiedEstimator::settle(std::span<uint32_t> members, const FacetList& facets, int depth) {
  FacetList& left = lists_[size_t(depth) + 1];
  const ReceiverHull hull = hull_of(members);
  if (settle_by_certificate(members, hull, facets, left)) return;
  if (left.size() < options_.split_above || members.size() < 2 * options_.smallest_cluster ||
      depth >= most_depth) {
    mask(members, left);
    return;
  }
  // halved at the median along the longest axis
  Box box;
  for (const uint32_t m : members) box.grow(receivers_[m].origin);
  const Vec3 extent = box.extent();
  const size_t axis = extent.x >= extent.y && extent.x >= extent.z ? 0
                      : extent.y >= extent.z                       ? 1
                                                                   : 2;
  const auto middle = members.begin() + std::ptrdiff_t(members.size() / 2);
  std::nth_element(members.begin(), middle, members.end(), [&](uint32_t a, uint32_t b) {
    const float p = receivers_[a].origin[axis], q = receivers_[b].origin[axis];
    return p != q ? p < q : a < b;
  });
  settle(members.first(members.size() / 2), left, depth + 1);
  settle(members.subspan(members.size() / 2), left, depth + 1);
}

namespace {

// Expected variance of a mask's share. Edges of all directions through a lattice err by 0.09
// samples squared per boundary pair on average (measured; docs/certified.md); more is assumed here,
// because edges along the lattice err by more.
float mask_variance(const MaskFrame& frame, const MaskWeights& weights, const MaskWeight& sums) {
  if (sums.boundary_pairs == 0) return 0;
  float most = 0;
  for (int i = 0; i < frame.corner_count(); ++i) {
    const MaskFrame::Corner& c = frame.corners()[i];
    most = std::max(most, weight_of(weights, int(c.k), int(c.j)));
  }
  return 0.15f * float(sums.boundary_pairs) * sqr(most / sums.all);
}

}  // namespace

void CertifiedEstimator::mask(std::span<const uint32_t> members, const FacetList& facets) {
  CoverageMask mask;
  float open_by_row[most_mask_rows];
  for (const uint32_t m : members) {
    const ShadowReceiver& r = receivers_[m];
    const uint64_t bits = mix64(r.stream + 0x5851f42d4c957f2dull);
    const Vec2 shift{unit_float(uint32_t(bits)), unit_float(uint32_t(bits >> 32))};
    ++counters_.masks;
    counters_.mask_facets += facets.size();
    cover(*frame_, facets, frame_->to_canvas(Vec3d(r.origin)), shift, mask);
    SourceVisibility& o = out_[m];
    o.answer = is_complete_ ? ShadowAnswer::masked : ShadowAnswer::mixed;
    if (!mask.is_any_open) continue;
    const MaskWeights weights = mask_weights(*frame_, Vec3d(r.position), r.normal, shift);
    const MaskWeight weight = weigh(*frame_, mask, weights, open_by_row);
    o.visible = weight.share();
    o.variance = mask_variance(*frame_, weights, weight);
    if (!is_complete_) add_rays(m, mask, weights, open_by_row, weight.open, weight.all, shift);
  }
}

void CertifiedEstimator::add_rays(uint32_t member, const CoverageMask& mask,
                                  const MaskWeights& weights, const float* open_by_row, float open,
                                  float all, const Vec2& shift) {
  if (!(open > 0)) return;
  SourceVisibility& o = out_[member];
  const ShadowReceiver& r = receivers_[member];
  const float share = open / all;
  const float wanted = std::ceil(sqr(0.5f * share / options_.residual_error));
  const uint32_t n = uint32_t(std::clamp(wanted, 1.0f, float(options_.most_rays)));
  o.rays = n;
  // finish_rays takes away what rays find hidden; V being 0 or 1, its variance is at most 1/4
  o.variance += share * share / (4 * float(n));
  // systematic sampling: n equidistant targets over the open weight, with one random start
  const float start = unit_float(uint32_t(mix64(r.stream + 0x14057b7ef767814full)));
  float passed = 0;
  int row = 0, k = -1;
  float left_in_row = 0;
  uint32_t bits = 0;
  const Vec3d first = frame_->first_sample();
  uint32_t i = 0;
  for (row = 0; row < frame_->lattice().rows && i < n; ++row) {
    if (open_by_row[row] <= 0) continue;
    const float row_end = passed + open_by_row[row];
    bits = mask.open.row[row];
    left_in_row = passed;
    k = -1;
    while (i < n) {
      const float target = (float(i) + start) / float(n) * open;
      if (target >= row_end) break;
      while (bits != 0 && (k < 0 || left_in_row <= target)) {
        k = std::countr_zero(bits);
        bits &= bits - 1;
        left_in_row += weight_of(weights, k, row);
      }
      const Vec3d target_point = first + frame_->step_k() * (double(k) + double(shift.x)) +
                                 frame_->step_j() * (double(row) + double(shift.y)) +
                                 source_->plane.normal * target_gap_;
      segments_.push_back({r.origin, Vec3(target_point)});
      ray_receivers_.push_back(member);
      ++i;
    }
    passed = row_end;
  }
  o.rays = i;  // rounding may leave out the last
}

void CertifiedEstimator::finish_rays(FoundFacets& found) {
  if (segments_.empty()) return;
  hits_.resize(segments_.size());
  scene_->trace(segments_, hits_);
  for (size_t i = 0; i < segments_.size();) {
    const uint32_t m = ray_receivers_[i];
    SourceVisibility& o = out_[m];
    uint32_t hidden = 0;
    for (; i < segments_.size() && ray_receivers_[i] == m; ++i) {
      if (hits_[i] == ray_is_free) continue;
      ++hidden;
      if (hits_[i] != ray_is_stopped) found.add(hits_[i]);
    }
    o.visible *= float(o.rays - hidden) / float(o.rays);
  }
  found.trim(options_.most_found);
}

}  // namespace troffer
