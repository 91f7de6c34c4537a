#include "shadow/certified_light.h"

#include <algorithm>
#include <cmath>

namespace troffer {

namespace {

// 1. What the source would send; false if nobody gets any light.
bool begin_source(const SourceTask& task, CertifiedMemory& m) {
  ++m.counters.clusters;
  const auto n = uint32_t(task.cluster.size());
  m.members.clear();
  m.sums.assign(n, {});
  for (uint32_t i = 0; i < n; ++i) {
    if (!(m.unoccluded[i] > 0)) continue;
    m.members.push_back(i);
    m.allowed[i] += task.request.brightness * m.unoccluded[i];
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

// Rays were queued by cells' own light, whose sum is not quite that of the whole source: scales it
// as set_answer does. Integrals of an integrand remain sums over cells.
void scale_rays(size_t first, std::span<const CellSum> sums, std::span<const float> unoccluded,
                RayQueue& queue) {
  for (size_t i = first; i < queue.open.size(); ++i) {
    RayQueue::OpenPair& p = queue.open[i];
    p.light *= unoccluded[p.member] / sums[p.member].unoccluded;
  }
}

// 2. to 5. for flat sources.
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
  target.tolerance = 2e-6 * magnitude;  // as the shaft has it
  m.queue.sources.push_back(target);
  const size_t first_ray = m.queue.open.size();
  divide_flat(task, m.members, hull, whole, scene, m.gather, m.counters);
  SourceResults results{m.sums, m.queue, m.counters};
  uint64_t stream = task.request.stream;
  for (const SourcePart& part : m.gather.parts.all())
    settle_flat_part(task, part, stream, m.part, results);
  FoundFacets& found = *task.request.found;
  if (found.is_hopeless && found.rim == FoundFacets::Rim::unknown)
    found.rim = has_rim(source, target.tolerance, task.options.most_found, scene)
                    ? FoundFacets::Rim::some
                    : FoundFacets::Rim::none;
  scale_rays(first_ray, m.sums, m.unoccluded, m.queue);
}

// 2. to 5. for spheres.
void settle_sphere(const SourceTask& task, ShadowScene& scene, CertifiedMemory& m) {
  const SphereSource& source = *task.request.sphere;
  RaySource target = ray_source(task);
  target.is_round = true;
  target.centre = source.centre;
  target.radius = source.radius;
  target.own = source.own;
  m.queue.sources.push_back(target);
  divide_sphere(task, m.members, hull_of(task.cluster, m.members), scene, m.gather, m.counters);
  SourceResults results{m.sums, m.queue, m.counters};
  for (SourcePart& part : m.gather.parts.all()) settle_sphere_part(task, part, m.part, results);
}

// A request whose answers wait for rays.
struct Waiting {
  uint32_t request, source;  // `source`: in the queue
  size_t first;              // of its answers in CertifiedMemory::waiting
};

// 6. What rays find completes the answers that wait.
void finish_by_rays(std::span<const Waiting> waiting, size_t receivers, ShadowScene& scene,
                    const CertifiedOptions& options, CertifiedMemory& m, const TakeAnswers& take) {
  for (float& e : m.allowed) e *= options.residual_error;
  std::vector<size_t> first_of_source(m.queue.sources.size(), 0);
  for (const Waiting& w : waiting) first_of_source[w.source] = w.first;
  for (const RayAnswer& a :
       cast_residual_rays(m.queue, scene, m.allowed, options.rays, options.most_found, m.rays))
    add_rays(a, m.waiting[first_of_source[a.source] + a.member]);
  for (const Waiting& w : waiting)
    take(w.request, std::span(m.waiting).subspan(w.first, receivers));
}

}  // namespace

void certified_light(const ShadowCluster& cluster, std::span<const LightRequest> requests,
                     ShadowIntegrand* integrand, ShadowScene& scene,
                     const CertifiedOptions& options, CertifiedMemory& m, const TakeAnswers& take) {
  const size_t n = cluster.size();
  if (n == 0) return;
  m.allowed.assign(n, 0);
  m.queue.clear();
  m.waiting.clear();
  m.wanted_points.resize(n);
  m.answers.resize(n);
  std::vector<Waiting> waiting;
  for (uint32_t r = 0; r < requests.size(); ++r) {
    const LightRequest& request = requests[r];
    if (request.flat != nullptr)
      unoccluded_light(cluster, *request.flat, m.unoccluded);
    else
      unoccluded_light(cluster, *request.sphere, m.unoccluded);
    const SourceTask task{options, cluster, request, r, m.unoccluded, integrand, m.wanted_points};
    const size_t queued = m.queue.size();
    if (begin_source(task, m)) {
      if (request.flat != nullptr)
        settle_flat(task, scene, m);
      else
        settle_sphere(task, scene, m);
    }
    for (size_t i = 0; i < n; ++i) set_answer(m.sums[i], m.unoccluded[i], m.answers[i]);
    if (m.queue.size() == queued) {
      take(r, m.answers);
      continue;
    }
    waiting.push_back({r, uint32_t(m.queue.sources.size() - 1), m.waiting.size()});
    m.waiting.insert(m.waiting.end(), m.answers.begin(), m.answers.end());
  }
  finish_by_rays(waiting, n, scene, options, m, take);
}

}  // namespace troffer
