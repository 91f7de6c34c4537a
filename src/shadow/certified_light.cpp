#include "shadow/certified_light.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "shadow/divide_sky_patch.h"
#include "shadow/pilot_rays.h"

namespace troffer {

namespace {

// Step 1: collects the receivers that the source would reach. Returns false if there are none.
bool begin_source(const SourceTask& task, CertifiedMemory& m) {
  ++m.counters.clusters;
  const auto n = uint32_t(task.cluster.size());
  m.members.clear();
  m.sums.assign(n, {});
  for (uint32_t i = 0; i < n; ++i) {
    if (!(m.unoccluded[i] > 0)) continue;
    m.members.push_back(i);
    m.wanted_points[i] = task.integrand == nullptr ? 0 : task.integrand->points(task.number, i);
  }
  return !m.members.empty();
}

RaySource ray_source(const SourceTask& task) {
  RaySource s;
  s.found = task.request.found;
  s.brightness = task.request.brightness;
  return s;
}

// Rays were queued with the unoccluded light of cells, whose sum differs slightly from that of the
// whole source. Scales them as set_answer does. Integrals of an integrand remain sums over cells.
void scale_rays(size_t first, std::span<const CellSum> sums, std::span<const float> unoccluded,
                RayQueue& queue) {
  for (size_t i = first; i < queue.open.size(); ++i) {
    RayQueue::OpenPair& p = queue.open[i];
    p.light *= unoccluded[p.member] / sums[p.member].unoccluded;
  }
}

// Steps 2 to 5 for flat sources.
void settle_flat(const SourceTask& task, ShadowScene& scene, CertifiedMemory& m) {
  const FlatSource& source = *task.request.flat;
  const ReceiverHull hull = hull_of(task.cluster, m.members);
  double magnitude = hull.magnitude;
  for (const Vec3d& c : source.corners())
    magnitude = std::max({magnitude, std::abs(c.x), std::abs(c.y), std::abs(c.z)});
  const FlatCell whole = visible_part(source, hull);
  if (whole.corner_count == 0) return;
  RaySource target = ray_source(task);
  target.point = source.plane.origin;
  target.normal = source.plane.normal;
  target.tolerance = 2e-6 * magnitude;  // the tolerance of the shaft
  m.queue.sources.push_back(target);
  const size_t first_ray = m.queue.open.size();
  if (task.request.far != nullptr)
    divide_sky_patch(task, m.members, hull, whole, scene, m.gather, m.counters);
  else
    divide_flat(task, m.members, hull, whole, scene, m.gather, m.counters);
  FoundFacets& found = *task.request.found;
  const bool is_far = task.request.far != nullptr;
  if (!is_far && found.is_over_budget() && found.rim == FoundFacets::Rim::unknown)
    found.rim = has_rim(source, target.tolerance, task.options.most_found, scene)
                    ? FoundFacets::Rim::some
                    : FoundFacets::Rim::none;
  SourceResults results{m.sums, m.queue, m.counters, &m.left};
  uint64_t stream = task.request.stream;
  for (const SourcePart& part : m.gather.parts.all())
    settle_flat_part(task, part, stream, scene, m.part, results);
  scale_rays(first_ray, m.sums, m.unoccluded, m.queue);
}

// Steps 2 to 5 for spheres.
void settle_sphere(const SourceTask& task, ShadowScene& scene, CertifiedMemory& m) {
  const SphereSource& source = *task.request.sphere;
  RaySource target = ray_source(task);
  target.is_round = true;
  target.centre = source.centre;
  target.radius = source.radius;
  target.own = source.own;
  m.queue.sources.push_back(target);
  divide_sphere(task, m.members, hull_of(task.cluster, m.members), scene, m.gather, m.counters);
  SourceResults results{m.sums, m.queue, m.counters, nullptr};
  for (SourcePart& part : m.gather.parts.all()) settle_sphere_part(task, part, m.part, results);
}

// A request whose answers are complete only after rays have been cast.
struct Waiting {
  uint32_t request, source;  // `source`: index in the queue
  size_t first;              // index of its first answer in CertifiedMemory::waiting
};
// Rays are cast as soon as more pairs than this wait, which limits the memory of the queue.
constexpr size_t most_waiting = 1 << 16;

// Sets the error allowed to the queued rays of each receiver. If the rays of a cluster are cast in
// several batches, a batch gets the square root of its share of the light. The variances of all
// batches then add up to the allowed one.
void set_allowed(const CertifiedOptions& options, CertifiedMemory& m) {
  m.allowed.assign(m.total.size(), 0);
  for (const RayQueue::OpenPair& p : m.queue.open)
    m.allowed[p.member] += m.queue.sources[p.source].brightness * p.light;
  for (size_t i = 0; i < m.allowed.size(); ++i) {
    const float share = m.total[i] > 0 ? std::min(m.allowed[i] / m.total[i], 1.0f) : 1;
    m.allowed[i] =
        options.residual_error * m.total[i] * (m.is_cast_in_parts ? std::sqrt(share) : 1);
  }
}

// Step 6: casts the queued rays and completes the answers that wait for them.
void finish_by_rays(std::vector<Waiting>& waiting, size_t receivers, ShadowScene& scene,
                    const CertifiedOptions& options, CertifiedMemory& m, const TakeAnswers& take) {
  set_allowed(options, m);
  std::vector<size_t> first_of_source(m.queue.sources.size(), 0);
  for (const Waiting& w : waiting) first_of_source[w.source] = w.first;
  for (const RayAnswer& a :
       cast_residual_rays(m.queue, scene, m.allowed, options.rays, options.most_found, m.rays))
    add_rays(a, m.waiting[first_of_source[a.source] + a.member]);
  for (const Waiting& w : waiting)
    take(w.request, std::span(m.waiting).subspan(w.first, receivers));
  waiting.clear();
  m.queue.clear();
  m.waiting.clear();
}

// Sets the unoccluded light of all requests and orders the requests, strongest first.
void find_unoccluded(const ShadowCluster& cluster, std::span<const LightRequest> requests,
                     CertifiedMemory& m) {
  m.all_unoccluded.clear();
  m.total.assign(cluster.size(), 0);
  std::vector<double> strength;
  for (const LightRequest& request : requests) {
    if (request.flat != nullptr)
      unoccluded_light(cluster, *request.flat, m.unoccluded);
    else
      unoccluded_light(cluster, *request.sphere, m.unoccluded);
    m.all_unoccluded.insert(m.all_unoccluded.end(), m.unoccluded.begin(), m.unoccluded.end());
    double sum = 0;
    for (size_t i = 0; i < cluster.size(); ++i) {
      const float light = request.brightness * m.unoccluded[i];
      m.total[i] += light;
      sum += double(light);
    }
    strength.push_back(sum);
  }
  m.order.resize(requests.size());
  std::iota(m.order.begin(), m.order.end(), 0u);
  std::stable_sort(m.order.begin(), m.order.end(),
                   [&](uint32_t a, uint32_t b) { return strength[a] > strength[b]; });
}

// Error and cost limits of one source's masks. A source with the share s of the light is worth at
// most s / (4 E²) rays, each of variance ¼ or less. A mask with more facets than these rays pay for
// is not worth its cost.
MaskBudget mask_budget_of(const ShadowCluster& cluster, const LightRequest& request,
                          const CertifiedOptions& options, CertifiedMemory& m) {
  constexpr double least_budget = 256, least_far_budget = 64,
                   most_budget = facets_per_ray * most_rays_of_receiver;
  MaskBudget p;
  p.error = options.mask_error;
  if (!(p.error > 0)) return p;
  double own = 0, total = 0;
  m.seen.assign(m.total.size(), 0);
  m.rest.assign(m.total.size(), 0);
  m.floor.assign(m.total.size(), 0);
  const float inverse = request.brightness > 0 ? 1 / request.brightness : 0;
  for (size_t i = 0; i < m.total.size(); ++i) {
    own += double(request.brightness * m.unoccluded[i]);
    total += double(m.total[i]);
    m.done[i] += request.brightness * m.unoccluded[i];
    m.seen[i] = m.light[i] * inverse;
    m.rest[i] = std::max(m.total[i] - m.done[i], 0.0f) * inverse;
    m.floor[i] = cluster.receivers[i].floor * inverse / std::sqrt(float(m.order.size()));
  }
  const double share = total > 0 ? own / total : 1;
  // Masks may cost as much as rays. Beyond that, the error is too large and is reported.
  p.budget =
      std::clamp(share * facets_per_ray / (4 * sqr(double(p.error))), least_budget, most_budget);
  if (request.far != nullptr)
    p.budget = std::min(
        p.budget, std::max(2 * facets_per_ray * share * rays_for_error(m.far_open, double(p.error)),
                           least_far_budget));
  p.far_open = m.far_open;
  // The smaller the error, the more rays a mask replaces, so longer lists pay off.
  constexpr double break_even_error = 0.1;
  p.longest_list =
      p.budget * (request.far != nullptr ? 2 : std::pow(break_even_error / double(p.error), 1.5));
  p.seen = m.seen;
  p.rest = m.rest;
  p.floor = m.floor;
  p.sources = double(m.order.size());
  return p;
}

}  // namespace

void certified_light(const ShadowCluster& cluster, std::span<const LightRequest> requests,
                     ShadowIntegrand* integrand, ShadowScene& scene,
                     const CertifiedOptions& options, CertifiedMemory& m, const TakeAnswers& take) {
  const size_t n = cluster.size();
  if (n == 0) return;
  find_unoccluded(cluster, requests, m);
  const bool is_far = std::any_of(requests.begin(), requests.end(),
                                  [](const LightRequest& r) { return r.far != nullptr; });
  if (is_far) m.far_open = sky_open_share(cluster, requests, m.all_unoccluded, scene);
  m.light.assign(n, 0);
  m.done.assign(n, 0);
  m.is_cast_in_parts = false;
  m.queue.clear();
  m.waiting.clear();
  m.left.clear();
  m.wanted_points.resize(n);
  m.answers.resize(n);
  std::vector<Waiting> waiting;
  for (const uint32_t r : m.order) {
    const LightRequest& request = requests[r];
    const auto first = m.all_unoccluded.begin() + std::ptrdiff_t(r * n);
    m.unoccluded.assign(first, first + std::ptrdiff_t(n));
    const SourceTask task{
        options,      cluster,   request,         r,
        m.unoccluded, integrand, m.wanted_points, mask_budget_of(cluster, request, options, m)};
    const size_t queued = m.queue.size();
    if (begin_source(task, m)) {
      if (request.flat != nullptr)
        settle_flat(task, scene, m);
      else
        settle_sphere(task, scene, m);
    }
    for (size_t i = 0; i < n; ++i) {
      set_answer(m.sums[i], m.unoccluded[i], m.answers[i]);
      m.light[i] += request.brightness * m.answers[i].visible * m.answers[i].unoccluded;
    }
    if (m.queue.size() == queued) {
      take(r, m.answers);
      continue;
    }
    waiting.push_back({r, uint32_t(m.queue.sources.size() - 1), m.waiting.size()});
    m.waiting.insert(m.waiting.end(), m.answers.begin(), m.answers.end());
    if (m.queue.size() <= most_waiting) continue;
    m.is_cast_in_parts = true;
    finish_by_rays(waiting, n, scene, options, m, take);
  }
  finish_by_rays(waiting, n, scene, options, m, take);
}

}  // namespace troffer
