#include "shadow/certified.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "light/irradiance.h"
#include "light/polygon.h"

namespace troffer {

ReceiverHull CertifiedEstimator::hull_of(std::span<const uint32_t> members) {
  hull_origins_.clear();
  hull_normals_.clear();
  for (const uint32_t m : members) {
    hull_origins_.push_back(receivers_[m].origin);
    hull_normals_.push_back(receivers_[m].horizon);
  }
  return bound_receivers(hull_origins_, hull_normals_);
}

void CertifiedEstimator::irradiance(const FlatSource& source, std::span<const Vec3d> corners,
                                    std::vector<float>& values) {
  values.resize(receivers_.size());
  const Parallelogram& p = source.plane;
  if (!source.is_disk) return unoccluded_irradiance(corners, p.normal, arrays_, values.data());
  const Vec3d centre = p.origin + (p.u + p.v) * 0.5;
  for (size_t i = 0; i < receivers_.size(); ++i) {
    const Vec3d x = arrays_.position_at(i);
    const bool is_before = dot(p.normal, x - centre) > plane_rounding(x, centre);
    values[i] =
        is_before
            ? float(disk_irradiance(centre, p.normal, 0.5 * length(p.u), x, arrays_.normal_at(i)))
            : 0;
  }
}

std::span<const float> CertifiedEstimator::unoccluded(const FlatSource& source) {
  irradiance(source, source.corners(), unoccluded_);
  return unoccluded_;
}

void CertifiedEstimator::begin_cluster(std::span<const ShadowReceiver> receivers) {
  receivers_ = receivers;
  arrays_.assign(receivers.size());
  has_own_horizons_ = false;
  members_.clear();
  for (const ShadowReceiver& r : receivers) {
    arrays_.set(members_.size(), r.position, r.normal);
    has_own_horizons_ = has_own_horizons_ || length_squared(r.normal - r.horizon) > 1e-12f;
    members_.push_back(uint32_t(members_.size()));
  }
  if (has_own_horizons_)
    for (const ShadowReceiver& r : receivers) arrays_.horizons.push_back(r.horizon);
  if (!receivers.empty()) cluster_hull_ = hull_of(members_);
  unhidden_.assign(receivers.size(), 0);
  rays_.begin(receivers.size());
}

// Receivers that some light can reach become members_; false if there are none. unoccluded_ is set
// already.
bool CertifiedEstimator::begin(const SourceTerms& terms, ShadowScene& scene, FoundFacets& found,
                               std::span<SourceVisibility> out) {
  ++counters_.clusters;
  terms_ = terms;
  scene_ = &scene;
  found_ = &found;
  out_ = out;
  cell_stream_ = terms.stream;
  own_ = no_round_source;
  const size_t n = receivers_.size();
  cell_sums_.assign(n, 0);
  kinds_.assign(n, 0);
  wanted_points_.assign(n, 0);
  members_.clear();
  for (uint32_t i = 0; i < n; ++i) {
    out[i] = {};
    out[i].unoccluded = unoccluded_[i];
    if (!(unoccluded_[i] > 0)) continue;
    members_.push_back(i);
    unhidden_[i] += terms.brightness * unoccluded_[i];
    if (terms.integrand != nullptr) wanted_points_[i] = terms.integrand->points(i);
  }
  return !members_.empty();
}

void CertifiedEstimator::gather(const ReceiverHull& hull, std::span<const Vec3d> outline,
                                const Vec3d& normal, size_t most) {
  const Shaft shaft = make_shaft(hull, outline, normal, scene_->magnitude());
  Box receivers, source;
  for (int i = 0; i < hull.count; ++i) receivers.grow(Vec3(hull.corners[size_t(i)]));
  for (const Vec3d& c : outline) source.grow(Vec3(c));
  scene_->candidates(shaft.all(), receivers, source, most, own_, candidates_);
  is_complete_ = candidates_.is_complete;
  ++counters_.gathers;
  counters_.candidates += candidates_.facets.size();
  counters_.incomplete += is_complete_ ? 0 : 1;
}

// A last try keeps few, for what it finds stays incomplete.
size_t CertifiedEstimator::most_candidates(bool is_last) const {
  return is_last ? std::min(options_.longest_list, 4 * options_.most_found) : options_.longest_list;
}

namespace {

double diameter(std::span<const Vec3d> corners) {
  double most = 0;
  for (size_t i = 0; i < corners.size(); ++i)
    for (size_t j = 0; j < i; ++j) most = std::max(most, length_squared(corners[i] - corners[j]));
  return std::sqrt(most);
}

// Solid angle of the facet from a point, roughly.
float apparent_size(const Quad& q, const Vec3& x) {
  const Vec3 area = cross(q[2] - q[0], q[3] - q[1]) * 0.5f;
  const Vec3 d = (q[0] + q[2]) * 0.5f - x;
  const float square = dot(d, d) + 1e-12f;
  return std::abs(dot(area, d)) / (square * std::sqrt(square));
}

}  // namespace

// Incomplete lists keep what hides most, and what rays met.
void CertifiedEstimator::shorten_candidates(const Vec3d& centre) {
  std::vector<FacetToAdd>& c = candidates_.facets;
  for (const FoundFacets::Entry& e : found_->entries()) {
    const bool is_known =
        std::any_of(c.begin(), c.end(), [&](const FacetToAdd& f) { return f.id == e.id; });
    if (!is_known) c.push_back({scene_->facet(e.id), e.id, false});
  }
  if (c.size() <= options_.most_found) return;
  const Vec3 x(centre);
  std::vector<std::pair<float, uint32_t>> order;
  for (uint32_t i = 0; i < c.size(); ++i) {
    const bool is_found = std::any_of(found_->entries().begin(), found_->entries().end(),
                                      [&](const auto& e) { return e.id == c[i].id; });
    order.emplace_back(is_found ? -1e30f : -apparent_size(c[i].quad, x), i);
  }
  std::nth_element(order.begin(), order.begin() + std::ptrdiff_t(options_.most_found), order.end());
  std::vector<FacetToAdd> kept;
  for (size_t i = 0; i < options_.most_found; ++i) kept.push_back(c[order[i].second]);
  c = std::move(kept);
}

// Gathers what can hide `part` of the source from the members; where that is too much, halves the
// larger of the two.
void CertifiedEstimator::divide(std::span<uint32_t> members, const ReceiverHull& hull,
                                const CertifiedCell& part, int halvings) {
  const bool is_last = is_last_try(halvings);
  gather(hull, part.all_corners(), source_->plane.normal, most_candidates(is_last));
  if (!candidates_.is_too_long) return settle_cells(members, hull, part);
  if (is_last) {
    found_->is_hopeless = true;
    shorten_candidates(hull.centre);
    return settle_cells(members, hull, part);
  }
  CertifiedCell first, second;
  const double hull_size = diameter({hull.corners.data(), size_t(hull.count)});
  const bool can_halve_members = members.size() >= 2 * options_.smallest_cluster;
  if (can_halve_members && hull_size > 0.5 * diameter(part.all_corners())) {
    const size_t half = halve_members(members);
    for (const std::span<uint32_t> side : {members.first(half), members.subspan(half)})
      divide(side, hull_of(side), part, halvings - 1);
  } else if (!source_->is_disk && halve(part, first, second)) {
    divide(members, hull, first, halvings - 1);
    divide(members, hull, second, halvings - 1);
  } else {
    divide(members, hull, part, 0);
  }
}

void CertifiedEstimator::settle_cells(std::span<uint32_t> members, const ReceiverHull& hull,
                                      const CertifiedCell& part) {
  std::vector<CertifiedCell> cells;
  if (source_->is_disk)
    cells.push_back(part);
  else
    cut_cells(part, hull, options_.cells, cells);
  // the whole source, or all of it that stands above a common horizon
  const bool is_whole = cells.size() == 1 && &part == whole_;
  for (const CertifiedCell& cell : cells) {
    ++counters_.cells;
    cell_stream_ = hash_of(cell_stream_, 1u);
    if (source_->is_disk || is_whole)
      cell_unoccluded_ = unoccluded_;
    else
      irradiance(*source_, cell.all_corners(), cell_unoccluded_);
    cell_members_.clear();
    for (const uint32_t m : members)
      if (cell_unoccluded_[m] > 0) cell_members_.push_back(m);
    if (cell_members_.empty()) continue;
    const bool is_mirrored =
        (mix64(cell_stream_ + receivers_[members[0]].stream + terms_.stream) & 1) != 0;
    const MaskFrame frame(cell.plane, options_.lattice, is_mirrored, hull.centre,
                          cell.all_outline(), source_->is_disk);
    frame_ = &frame;
    if (!is_complete_) rays_.set_frame(frame);
    FacetList& facets = lists_[0];
    facets.clear();
    facets.add_many(frame, candidates_.facets);
    facets.finish();
    const bool is_all = cell_members_.size() == members.size();
    settle(cell_members_, is_all ? hull : hull_of(cell_members_), facets, 0);
  }
}

void CertifiedEstimator::finish_sums() {
  constexpr auto bit = [](ShadowAnswer a) { return uint8_t(1u << uint32_t(a)); };
  for (const uint32_t m : members_) {
    SourceVisibility& o = out_[m];
    const uint8_t kinds = kinds_[m];
    if (kinds == 0 || !(cell_sums_[m] > 0)) continue;
    if (kinds == bit(ShadowAnswer::lit)) {
      o.visible = 1;
      o.answer = ShadowAnswer::lit;
    } else if (kinds == bit(ShadowAnswer::dark)) {
      o.visible = 0;
      o.answer = ShadowAnswer::dark;
    } else {
      o.visible = std::min(o.visible / cell_sums_[m], 1.0f);
      o.variance /= cell_sums_[m] * cell_sums_[m];
      o.answer =
          (kinds & bit(ShadowAnswer::mixed)) != 0 ? ShadowAnswer::mixed : ShadowAnswer::masked;
    }
    cell_sums_[m] = unoccluded_[m] / cell_sums_[m];
  }
}

// Facets between the source's outline, in the slab that rays may leave out.
void CertifiedEstimator::look_for_rim(const RaySource& target) {
  const Vec3d n = target.normal;
  const std::vector<Vec3d> corners = source_->corners();
  Vec3d middle;
  for (const Vec3d& c : corners) middle = middle + c * (1.0 / double(corners.size()));
  const double margin = 2 * target.tolerance;
  std::vector<Plane> planes;
  const auto add = [&](const Vec3d& outwards, const Vec3d& point) {
    planes.push_back({Vec3(outwards), float(dot(outwards, point) + margin)});
  };
  add(n, target.point);
  add(-n, target.point);
  Box box;
  for (size_t i = 0; i < corners.size(); ++i) {
    const Vec3d& c = corners[i];
    box.grow(Vec3(c));
    const Vec3d side = cross(corners[(i + 1) % corners.size()] - c, n);
    const double size = length(side);
    if (size > 0) add(side * ((dot(side, c - middle) < 0 ? -1 : 1) / size), c);
  }
  ShadowCandidates near;
  scene_->candidates(planes, box, box, options_.most_found, own_, near);
  bool has_rim = !near.is_complete;
  for (const FacetToAdd& f : near.facets)
    for (const Vec3& v : f.quad)
      has_rim = has_rim || dot(n, Vec3d(v) - target.point) > target.tolerance;
  found_->rim = has_rim ? FoundFacets::Rim::some : FoundFacets::Rim::none;
}

void CertifiedEstimator::evaluate(const FlatSource& source, const SourceTerms& terms,
                                  ShadowScene& scene, FoundFacets& found,
                                  std::span<SourceVisibility> out) {
  source_ = &source;
  does_horizon_hide_ = has_own_horizons_ && source.is_disk;
  if (receivers_.empty()) return;
  irradiance(source, source.corners(), unoccluded_);
  if (!begin(terms, scene, found, out)) return;
  const bool is_all = members_.size() == receivers_.size();
  const ReceiverHull hull = is_all ? cluster_hull_ : hull_of(members_);
  double magnitude = hull.magnitude;
  for (const Vec3d& c : source.corners())
    magnitude = std::max({magnitude, std::abs(c.x), std::abs(c.y), std::abs(c.z)});
  const CertifiedCell part = visible_part(source, hull);
  if (part.corner_count == 0) return;
  RaySource target;
  target.point = source.plane.origin;
  target.normal = source.plane.normal;
  target.tolerance = 2e-6 * magnitude;  // as the shaft has it
  target.found = &found;
  target.brightness = terms.brightness;
  target.tag = terms.tag;
  rays_.set_source(target);
  whole_ = &part;
  const size_t first_ray = rays_.size();
  divide(members_, hull, part, options_.most_halvings);
  if (found.is_hopeless && found.rim == FoundFacets::Rim::unknown) look_for_rim(target);
  finish_sums();
  rays_.scale(first_ray, cell_sums_);  // now unoccluded over the sum of the cells
}

std::span<const RayAnswer> CertifiedEstimator::end_cluster(ShadowScene& scene) {
  for (float& e : unhidden_) e *= options_.residual_error;
  return rays_.finish(scene, unhidden_, options_.rays, options_.most_found);
}

}  // namespace troffer
