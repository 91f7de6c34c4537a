#include "shadow/direct_rays.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "base/simd.h"
#include "shadow/cell_points.h"
#include "shadow/trace_rays.h"

namespace troffer {

namespace {

// Rays are traced when so many have gathered.
constexpr size_t batch = 4096;
constexpr uint32_t fewest_rays = 4;
constexpr uint32_t purpose_direct = 0x64697265u;

// A cell of four right angles, of which points are drawn evenly by solid angle: what a ray brings
// then varies by the receiver's cosine alone. Nothing for other cells.
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

// Cosine over density; below the horizon `below` times that.
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

// Sums over the rays of one receiver: of f V - b f, of its square, and of squared differences of
// neighbours.
struct RaySums {
  float value = 0, squares = 0, changes = 0;
};
TROFFER_MULTIVERSION
RaySums add_up(size_t n, const float* __restrict weights, const uint8_t* __restrict is_hidden,
               float control, float* __restrict values) {
  constexpr size_t lanes = 16;
  float value[lanes] = {}, squares[lanes] = {}, changes[lanes] = {};
  for (size_t i = 0; i < n; ++i) {
    const float free = weights[i] > 0 && is_hidden[i] == 0 ? weights[i] : 0.0f;
    values[i] = free - control * std::abs(weights[i]);
  }
  values[n] = values[n - 1];
  const size_t whole = n / lanes * lanes;
  for (size_t i = 0; i < whole; i += lanes)
    for (size_t k = 0; k < lanes; ++k) {
      const float v = values[i + k], change = values[i + k + 1] - v;
      value[k] += v;
      squares[k] += v * v;
      changes[k] += change * change;
    }
  for (size_t i = whole; i < n; ++i) {
    const float v = values[i], change = values[i + 1] - v;
    value[i - whole] += v;
    squares[i - whole] += v * v;
    changes[i - whole] += change * change;
  }
  RaySums sums;
  for (size_t k = 0; k < lanes; ++k) {
    sums.value += value[k];
    sums.squares += squares[k];
    sums.changes += changes[k];
  }
  return sums;
}

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
    rays_ = rays_for_error();
    if (m_.blocks.size() != rays_) m_.blocks = SobolBlocks(rays_);
    m_.numbers.resize(2 * size_t(rays_));
    control_ = std::clamp(found_.dense.open_share(), 0.0f, 1.0f);
  }

  void run() {
    m_.answers.clear();
    for (size_t first = 0, end = 0; first < members_.size(); first = end) {
      m_.segments.clear();
      m_.before.clear();
      m_.weights.clear();
      for (; end < members_.size() && m_.segments.size() < batch; ++end) add_rays(members_[end]);
      trace();
      for (size_t i = first, ray = 0; i < end; ++i, ray += rays_) note_answer(members_[i], ray);
    }
    add_answers();
    found_.dense.note(sums_.light, sums_.unoccluded, sums_.variance, sums_.random_variance);
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

  // Of the source's rays a part of it gets its share. As many as make the variance k p (1 - p) U² /
  // n what the masks' may be (Promise), for the mean share p that is open and the mean gain k over
  // random numbers, a power of two.
  uint32_t rays_for_error() {
    const auto most = double(task_.options.rays.most_rays);
    const Promise& promise = task_.promise;
    if (!(promise.error > 0)) return uint32_t(std::bit_floor(unsigned(most)));
    double seen = 0, own = 0, part = 0, floor = 0;
    for (const uint32_t m : members_) {
      seen += double(promise.seen[m]);
      own += double(task_.unoccluded[m]);
      floor += double(promise.floor[m]);
      for (size_t c = 0; c < m_.cells.size(); ++c) part += double(unoccluded(c, m));
    }
    const double p = std::max(double(found_.dense.open_share()), 0.02);
    const double all = std::max(own, 1e-300);
    const double allowed = std::max((seen / all + p) * p, sqr(floor / all));
    const double wanted = double(found_.dense.gain()) * p * (1 - std::min(p, 0.98)) /
                          (sqr(double(promise.error)) * allowed);
    const double kept = std::clamp(wanted, double(fewest_rays), most);
    found_.dense.note_wanted(double(members_.size()), kept);
    const double n = std::clamp(found_.dense.spread(kept), double(fewest_rays), most) *
                     (own > 0 ? part / own : 1);
    return uint32_t(std::bit_floor(unsigned(std::max(n * std::sqrt(2.0), 4.0))));
  }

  // Where a ray goes: which cell, and where on it.
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
    return {c, points_[c].area() * double(all / own), std::min(wanted / own, 0.99999994f)};
  }

  void add_rays(uint32_t member) {
    const ShadowReceiver& r = task_.cluster.receivers[member];
    m_.blocks.draw(hash_combine(r.pixel != 0 ? r.pixel : r.stream, task_.request.stream),
                   purpose_direct, r.pixel != 0 ? r.sample : 0, 2, m_.numbers.data());
    // as trace_rays.cpp has it
    const double origin_height = dot(source_.normal, Vec3d(r.origin) - source_.point);
    const double end = std::max(1 - 1.25 * source_.tolerance / origin_height, 1e-3);
    const size_t first = m_.segments.size();
    m_.segments.resize(first + rays_);
    m_.weights.resize(first + rays_);
    m_.before.resize(first + rays_, float(end));
    if (rectangle_)
      aim_by_angle(r, first);
    else
      aim_by_area(member, first);
  }

  // A horizon of the receiver's own hides what round sources have below it: such points have
  // negative weights.
  void aim_by_angle(const ShadowReceiver& r, size_t first) {
    LightPoints& p = m_.points;
    const float* numbers = m_.numbers.data();
    if (!sample_points(*rectangle_, r.position, rays_, numbers, numbers + rays_, p))
      std::fill_n(p.inverse_pdf.begin(), rays_, 0.0f);
    weigh_points(rays_, p.x.data(), p.y.data(), p.z.data(), p.inverse_pdf.data(), r.normal,
                 r.horizon, task_.does_horizon_hide() ? -1.0f : 0.0f, m_.weights.data() + first);
    for (uint32_t i = 0; i < rays_; ++i)
      m_.segments[first + i] = {r.origin, r.position + Vec3{p.x[i], p.y[i], p.z[i]},
                                no_round_source};
  }

  void aim_by_area(uint32_t member, size_t first) {
    const ShadowReceiver& r = task_.cluster.receivers[member];
    const Vec3d x(r.position), normal(r.normal), horizon(r.horizon);
    const double height = dot(source_.normal, x - source_.point);
    float all = 0;
    for (size_t c = 0; c < m_.cells.size(); ++c) all += unoccluded(c, member);
    for (uint32_t i = 0; i < rays_; ++i) {
      const Choice choice = choose(member, all, m_.numbers[i]);
      const Vec3d y = points_[choice.cell].at(choice.u, m_.numbers[rays_ + i]), d = y - x;
      const double f =
          height * std::max(dot(normal, d), 0.0) / sqr(length_squared(d)) * choice.inverse_density;
      const bool is_below = dot(horizon, d) <= 0;
      m_.weights[first + i] = !is_below ? float(f) : task_.does_horizon_hide() ? -float(f) : 0;
      m_.segments[first + i] = {r.origin, Vec3(y), no_round_source};
    }
  }

  // m_.is_hidden of all segments.
  void trace() {
    m_.is_hidden.resize(m_.segments.size());
    scene_.occluded(m_.segments, m_.before, m_.is_hidden);
    if (found_.rim == FoundFacets::Rim::none) return;
    m_.rest.clear();
    m_.rest_of.clear();
    for (uint32_t i = 0; i < m_.segments.size(); ++i) {
      if (m_.is_hidden[i] != 0 || !(m_.weights[i] > 0)) continue;
      m_.rest.push_back(m_.segments[i]);
      m_.rest.back().first = m_.before[i];
      m_.rest_of.push_back(i);
    }
    m_.hits.resize(m_.rest.size());
    scene_.trace(m_.rest, m_.hits);
    for (size_t k = 0; k < m_.rest.size(); ++k)
      m_.is_hidden[m_.rest_of[k]] = is_free(source_, m_.rest[k], m_.hits[k], scene_) ? 0 : 1;
  }

  // Keeps what the rays of a member say, for add_answers.
  void note_answer(uint32_t member, size_t first) {
    m_.values.resize(rays_ + 1);
    const RaySums sums = add_up(rays_, m_.weights.data() + first, m_.is_hidden.data() + first,
                                control_, m_.values.data());
    const auto squares = double(sums.squares), changes = double(sums.changes);
    double all = 0;
    for (size_t c = 0; c < m_.cells.size(); ++c) all += double(unoccluded(c, member));
    if (!(all > 0)) return;
    const auto n = double(rays_), mean = double(sums.value) / n;
    // Neighbours on the source differ by what their strata leave to chance. Where these are in
    // order the sequence gains more, and the error of all rays of a pixel falls faster than with
    // the root of their number, as N^-3/4; what is told here will be taken for independent.
    const double neighbours = changes / (2 * n * n);
    const double random = std::max(squares / n - sqr(mean), 0.0) / n;
    const double order = random > 0 ? std::min(neighbours / random, 1.0) : 1;
    const bool is_shared = task_.cluster.receivers[member].pixel != 0;
    const double shared = is_shared ? 1 / std::sqrt(double(task_.options.viewing_rays)) : 1;
    const double gain = (0.25 + 0.75 * sqr(order)) * (shared + (1 - shared) * order);
    m_.answers.push_back({member, all, mean + double(control_) * all, neighbours * gain, random});
  }

  // A member's own rays may all have met the same: the spread of all members' counts for one of n +
  // 1, and a ray of another answer for one of all.
  void add_answers() {
    double spread = 0;
    for (const DirectRayMemory::Answer& a : m_.answers) spread += a.variance / sqr(a.unoccluded);
    const auto n = double(rays_), answers = double(m_.answers.size());
    const double mean = spread / answers + 1 / sqr(n * answers);
    for (const DirectRayMemory::Answer& a : m_.answers) {
      const double variance = (n * a.variance + mean * sqr(a.unoccluded)) / (n + 1);
      CellSum& s = sums_of_[a.member];
      s.add(float(a.unoccluded), float(a.light / a.unoccluded), float(variance / sqr(a.unoccluded)),
            ShadowAnswer::mixed);
      s.rays += rays_;
      sums_.light += a.light;
      sums_.unoccluded += a.unoccluded;
      sums_.variance += variance;
      sums_.random_variance += a.random_variance;
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
  uint32_t rays_ = 0;
  float control_ = 0;
  struct Sums {
    double light = 0, unoccluded = 0, variance = 0, random_variance = 0;
  } sums_;
};

}  // namespace

void cast_direct_rays(const SourceTask& task, const SourcePart& part,
                      std::span<const uint32_t> members, ShadowScene& scene,
                      DirectRayMemory& memory, SourceResults& results) {
  if (!members.empty()) Caster(task, part, members, scene, memory, results).run();
}

}  // namespace troffer
