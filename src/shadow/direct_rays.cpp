#include "shadow/direct_rays.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "base/simd.h"
#include "base/units.h"
#include "shadow/cell_points.h"
#include "shadow/pilot_rays.h"
#include "shadow/trace_rays.h"
#include "shadow/vector_lanes.h"

namespace troffer {

namespace {

// Most rays traced in one call, unless a single receiver has more.
constexpr size_t batch = 4096;
// Variance of a Sobol sequence behind dense occluders, relative to that of independent rays.
constexpr double variance_kept = 0.8;
// Origin of rays that carry no light. It is outside of what Tracer traces.
constexpr float nowhere = 4e18f;
constexpr uint32_t purpose_direct = 0x64697265u;

// Returns a rectangular cell as a light primitive, of which points are drawn uniformly by solid
// angle. The contribution of a ray then varies only with the receiver's cosine. Returns nothing for
// other cells.
std::optional<LightPrimitive> rectangle_of(const FlatCell& cell) {
  if (cell.is_disk || cell.count != 0) return {};
  const Parallelogram& p = cell.plane;
  const double size_u = length(p.u), size_v = length(p.v);
  if (!(std::abs(dot(p.u, p.v)) <= 1e-6 * size_u * size_v) || !(size_u * size_v > 0)) return {};
  LightPrimitive out;
  out.shape = PrimitiveShape::rectangle;
  out.is_two_sided = true;
  out.vertex_count = 4;
  out.size_x = float(size_u);
  out.size_y = float(size_v);
  out.area = float(size_u * size_v);
  out.radius = float(0.5 * std::hypot(size_u, size_v));
  out.centroid = Vec3(p.origin + (p.u + p.v) * 0.5);
  out.axis_x = Vec3(p.u / size_u);
  out.axis_y = Vec3(p.v / size_v);
  out.normal = p.normal;
  const Vec3d corners[] = {p.origin, p.origin + p.u, p.origin + p.u + p.v, p.origin + p.v};
  for (size_t i = 0; i < 4; ++i) out.vertices[i] = Vec3(corners[i]);
  return out;
}

// Sets weights to cosine over density. Points below the horizon get `below` times that.
TROFFER_MULTIVERSION
void weigh_points(size_t n, const float* __restrict x, const float* __restrict y,
                  const float* __restrict z, const float* __restrict inverse_pdf,
                  const Vec3& normal, const Vec3& horizon, float below, float* __restrict weights) {
  const Vec3 a = normal, b = horizon;
  for (size_t i = 0; i < n; ++i) {
    const Vec3 d{x[i], y[i], z[i]};
    const float square = std::max(dot(d, d), 1e-30f);
    const float f = std::max(dot(d, a), 0.0f) * inverse_pdf[i] / std::sqrt(square);
    weights[i] = dot(d, b) > 0 ? f : below * f;
  }
}

// Turns points as seen from the receiver into segments from an origin that differs by `shift`,
// shortened to the share `end`.
TROFFER_MULTIVERSION
void shorten_segments(size_t n, const Vec3& shift, float end, float* __restrict x,
                      float* __restrict y, float* __restrict z) {
  const Vec3 s = shift;
  for (size_t i = 0; i < n; ++i) {
    x[i] = (x[i] + s.x) * end;
    y[i] = (y[i] + s.y) * end;
    z[i] = (z[i] + s.z) * end;
  }
}

// Sets the contribution f V - b f of each ray of a receiver, times `unit`. Returns the sum.
TROFFER_MULTIVERSION
float add_up(size_t n, const float* __restrict weights, const uint8_t* __restrict is_hidden,
             float control, float unit, float* __restrict values) {
  float sums[vector_lanes] = {};
  for (size_t i = 0; i < n; ++i) {
    const float free = weights[i] > 0 && is_hidden[i] == 0 ? weights[i] : 0.0f;
    values[i] = (free - control * std::abs(weights[i])) * unit;
  }
  const size_t whole = n / vector_lanes * vector_lanes;
  for (size_t i = 0; i < whole; i += vector_lanes)
    for (size_t k = 0; k < vector_lanes; ++k) sums[k] += values[i + k];
  for (size_t i = whole; i < n; ++i) sums[i - whole] += values[i];
  float sum = 0;
  for (const float v : sums) sum += v;
  return sum;
}

// Casts the rays for one part, in one call of run(); its members share the state of that call.
class Caster {
 public:
  Caster(const SourceTask& task, const SourcePart& part, std::span<const uint32_t> members,
         ShadowScene& scene, DirectRayMemory& memory, SourceResults& results)
      : task_(task),
        found_(*task.request.found),
        source_(results.rays.sources.back()),
        members_(members),
        scene_(scene),
        m_(memory),
        sums_of_(results.sums) {
    m_.cells.clear();
    rectangle_ = rectangle_of(part.cell);
    if (rectangle_)
      m_.cells.push_back(part.cell);
    else
      cut_cells(part.cell, part.hull, task.options.cells, m_.cells);
    for (const FlatCell& c : m_.cells) points_.emplace_back(c);
    set_unoccluded(part);
    set_rays();
    control_ = float(found_.dense.open_share);
  }

  void run() {
    m_.answers.clear();
    m_.spread.begin(blocks_, m_.blocks.size());
    const size_t at_once = std::max<size_t>(batch / rays_, 1);
    for (size_t first = 0; first < members_.size(); first += at_once) {
      const std::span<const uint32_t> some =
          members_.subspan(first, std::min(at_once, members_.size() - first));
      m_.segments.resize(some.size() * rays_);
      m_.weights.resize(some.size() * rays_);
      m_.ends.resize(some.size());
      for (size_t i = 0; i < some.size(); ++i) add_rays(i, some[i]);
      trace();
      for (size_t i = 0; i < some.size(); ++i) note_answer(i, some[i]);
    }
    add_answers();
  }

 private:
  void set_unoccluded(const SourcePart& part) {
    const size_t n = task_.cluster.size();
    m_.unoccluded.resize(m_.cells.size() * n);
    for (size_t c = 0; c < m_.cells.size(); ++c) {
      const bool is_all = m_.cells.size() == 1 && (part.is_whole || m_.cells[c].is_disk);
      if (!is_all)
        unoccluded_light(task_.cluster, *task_.request.flat, m_.cells[c].all_corners(), m_.values);
      const std::span<const float> of_cell = is_all ? task_.unoccluded : std::span(m_.values);
      std::copy_n(of_cell.begin(), n, m_.unoccluded.begin() + std::ptrdiff_t(c * n));
    }
  }
  float unoccluded(size_t cell, uint32_t member) const {
    return m_.unoccluded[cell * task_.cluster.size() + member];
  }

  // Gives the part its share of the source's rays: one block of a sequence, or three.
  void set_rays() {
    double own = 0, part = 0;
    for (const uint32_t m : members_) {
      own += double(task_.unoccluded[m]);
      for (size_t c = 0; c < m_.cells.size(); ++c) part += double(unoccluded(c, m));
    }
    const double n = direct_rays_of(task_, scene_) * (own > 0 ? part / own : 1);
    // the nearest 2^k or 3 · 2^k, by ratio
    const unsigned below = std::bit_floor(unsigned(std::max(n * std::sqrt(4 / 3.0), 4.0)));
    blocks_ = n > below * std::sqrt(1.5) ? 3 : 1;
    const uint32_t of_block = blocks_ == 3 ? below / 2 : below;
    rays_ = blocks_ * of_block;
    if (m_.blocks.size() != of_block) m_.blocks = SobolBlocks(of_block);
    m_.block.resize(2 * size_t(of_block));
    m_.numbers.resize(2 * size_t(rays_));
  }

  // Draws the random numbers of a receiver. Viewing rays of a pixel take successive blocks of one
  // sequence.
  void draw_numbers(const ShadowReceiver& r) {
    const size_t n = m_.blocks.size();
    for (uint32_t b = 0; b < blocks_; ++b) {
      m_.blocks.draw(hash_combine(r.pixel != 0 ? r.pixel : r.stream, task_.request.stream),
                     purpose_direct, (r.pixel != 0 ? r.sample : 0) * blocks_ + b, 2,
                     m_.block.data());
      for (size_t d = 0; d < 2; ++d)
        std::copy_n(m_.block.data() + d * n, n, m_.numbers.data() + d * rays_ + b * n);
    }
  }

  // The end point of a ray: a cell and a position in it.
  struct Choice {
    size_t cell;
    double inverse_density;  // m²
    float u;
  };
  Choice choose(uint32_t member, float all, float u) const {
    if (m_.cells.size() == 1) return {0, points_[0].area(), u};
    float wanted = u * all, own = 0;
    size_t c = 0;
    for (;; ++c) {
      own = unoccluded(c, member);
      if (wanted < own || c + 1 == m_.cells.size()) break;
      wanted -= own;
    }
    if (!(own > 0)) return {c, 0, 0};
    return {c, points_[c].area() * double(all / own), std::min(wanted / own, one_minus_epsilon)};
  }

  // Adds the rays of receiver i of the batch.
  void add_rays(size_t i, uint32_t member) {
    const size_t first = i * rays_;
    const ShadowReceiver& r = task_.cluster.receivers[member];
    draw_numbers(r);
    LightPoints& p = m_.points;
    if (!rectangle_)
      choose_by_area(member);
    else if (!sample_points(*rectangle_, r.position, rays_, m_.numbers.data(),
                            m_.numbers.data() + rays_, p))
      std::fill_n(p.inverse_pdf.begin(), rays_, 0.0f);
    // A receiver's own horizon hides points of round sources below it. Such points get negative
    // weights: they count as hidden.
    weigh_points(rays_, p.x.data(), p.y.data(), p.z.data(), p.inverse_pdf.data(), r.normal,
                 r.horizon, task_.does_horizon_hide() ? -1.0f : 0.0f, m_.weights.data() + first);
    // the same end as in trace_rays.cpp
    const double origin_height = dot(source_.normal, Vec3d(r.origin) - source_.point);
    m_.ends[i] = float(std::max(1 - 1.25 * source_.tolerance / origin_height, 1e-3));
    shorten_segments(rays_, r.position - r.origin, m_.ends[i], p.x.data(), p.y.data(), p.z.data());
    for (size_t a = 0; a < 3; ++a) {
      const std::vector<float>& way = a == 0 ? p.x : a == 1 ? p.y : p.z;
      std::fill_n(m_.segments.from[a].data() + first, rays_, r.origin[a]);
      std::copy_n(way.data(), rays_, m_.segments.way[a].data() + first);
    }
    for (uint32_t k = 0; k < rays_; ++k)
      if (m_.weights[first + k] == 0) m_.segments.from[0][first + k] = nowhere;
  }

  // Draws points in proportion to the unoccluded light of cells, uniformly by area within each.
  void choose_by_area(uint32_t member) {
    const ShadowReceiver& r = task_.cluster.receivers[member];
    const Vec3d x(r.position);
    const double height = dot(source_.normal, x - source_.point);
    LightPoints& p = m_.points;
    p.resize(rays_);
    float all = 0;
    for (size_t c = 0; c < m_.cells.size(); ++c) all += unoccluded(c, member);
    for (uint32_t i = 0; i < rays_; ++i) {
      const Choice choice = choose(member, all, m_.numbers[i]);
      const Vec3d d = points_[choice.cell].at(choice.u, m_.numbers[rays_ + i]) - x;
      const double square = std::max(length_squared(d), 1e-30);
      p.x[i] = float(d.x);
      p.y[i] = float(d.y);
      p.z[i] = float(d.z);
      p.inverse_pdf[i] = float(height * choice.inverse_density / (square * std::sqrt(square)));
    }
  }

  // Sets is_hidden for the segments of the batch.
  void trace() {
    m_.is_hidden.resize(m_.segments.size());
    scene_.occluded(m_.segments, m_.is_hidden);
    if (found_.rim == FoundFacets::Rim::none) return;
    m_.rest.clear();
    m_.rest_of.clear();
    for (uint32_t at = 0; at < m_.segments.size(); ++at)
      if (m_.is_hidden[at] == 0 && m_.weights[at] > 0) add_rest(at, m_.ends[at / rays_]);
    m_.hits.resize(m_.rest.size());
    scene_.trace(m_.rest, m_.hits);
    for (size_t k = 0; k < m_.rest.size(); ++k)
      m_.is_hidden[m_.rest_of[k]] = is_free(source_, m_.rest[k], m_.hits[k], scene_) ? 0 : 1;
  }

  // Adds the remainder of a segment that was shortened at `end`.
  void add_rest(uint32_t at, float end) {
    const SegmentArrays& s = m_.segments;
    const Vec3 from{s.from[0][at], s.from[1][at], s.from[2][at]};
    const Vec3 way{s.way[0][at], s.way[1][at], s.way[2][at]};
    m_.rest.push_back({from, from + way / end, no_round_source, end});
    m_.rest_of.push_back(at);
  }

  // Stores the result of receiver i of the batch until add_answers.
  void note_answer(size_t i, uint32_t member) {
    double all = 0;
    for (size_t c = 0; c < m_.cells.size(); ++c) all += double(unoccluded(c, member));
    if (!(all > 0)) return;
    m_.values.resize(rays_);
    const float sum = add_up(rays_, m_.weights.data() + i * rays_, m_.is_hidden.data() + i * rays_,
                             control_, float(std::min(1 / all, 1e30)), m_.values.data());
    m_.answers.push_back({member, float(all), sum / float(rays_) + control_});
    draw_numbers(task_.cluster.receivers[member]);
    m_.spread.add(m_.values, m_.numbers);
  }

  void add_answers() {
    if (m_.answers.empty()) return;
    const std::span<const double> variances = m_.spread.variances();
    for (size_t i = 0; i < m_.answers.size(); ++i) {
      const DirectRayMemory::Answer& a = m_.answers[i];
      CellSum& s = sums_of_[a.member];
      s.add(a.unoccluded, a.share, float(variances[i]), ShadowAnswer::mixed);
      s.rays += rays_;
    }
  }

  const SourceTask& task_;
  FoundFacets& found_;
  const RaySource source_;
  std::span<const uint32_t> members_;
  ShadowScene& scene_;
  DirectRayMemory& m_;
  std::span<CellSum> sums_of_;  // per receiver
  std::vector<CellPoints> points_;
  std::optional<LightPrimitive> rectangle_;
  uint32_t rays_ = 0, blocks_ = 1;
  float control_ = 0;
};

}  // namespace

namespace {

// Returns the rays that a source's own visible share deserves if it is half open, as in
// plan_rays.cpp.
double rays_for_share(const SourceTask& task) {
  const RayLimits& limits = task.options.rays;
  const double wanted =
      std::min(0.25 / sqr(double(limits.pair_error)), double(limits.most_pair_rays));
  return std::min(wanted, double(limits.most_share_rays) / task.promise.sources);
}

}  // namespace

double direct_rays_of(const SourceTask& task, ShadowScene& scene) {
  FoundFacets::DirectRayPlan& dense = task.request.found->dense;
  if (dense.is_known()) return dense.rays;
  const LightRequest& request = task.request;
  dense.open_share =
      open_share(request, request.batch.empty() ? task.cluster.receivers : request.batch, scene);
  dense.rays = double(task.options.rays.most_direct_rays);
  const MaskBudget& promise = task.promise;
  if (!(promise.error > 0)) return dense.rays;
  double own = 0, others = 0;
  for (size_t i = 0; i < task.cluster.size(); ++i) {
    own += double(task.unoccluded[i]);
    others += double(promise.seen[i] + promise.rest[i]);
  }
  const double wanted = variance_kept * own / ((own + others) * sqr(double(promise.error)));
  dense.rays = std::clamp(std::max(wanted, rays_for_share(task)), fewest_rays, dense.rays);
  return dense.rays;
}

void cast_direct_rays(const SourceTask& task, const SourcePart& part,
                      std::span<const uint32_t> members, ShadowScene& scene,
                      DirectRayMemory& memory, SourceResults& results) {
  if (!members.empty()) Caster(task, part, members, scene, memory, results).run();
}

}  // namespace troffer
