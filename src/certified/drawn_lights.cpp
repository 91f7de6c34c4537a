#include "certified/drawn_lights.h"

#include <algorithm>
#include <cmath>

#include "base/box.h"
#include "base/random.h"
#include "light/light.h"
#include "transport/costs.h"

namespace troffer {

namespace {

// Error of one sample. N points of an Owen-Sobol sequence over lights half in shadow err by about
// this times N^-2/3, relative to their light (docs/method/certified-appendix.md, "Many lights").
constexpr float error_of_one = 0.4f;
constexpr float most_draws = 256;  // largest number of samples per hit
// Costs of a certified light in shadow rays: per hit, and per cluster. Profiled
// (docs/method/certified-appendix.md, "Many lights").

float points_of_pixel(float share, float error) {
  return std::pow(share * error_of_one / error, 1.5f);
}

void sort_by_sources(const LightGroups& groups, std::vector<uint32_t>& chosen) {
  std::sort(chosen.begin(), chosen.end(), [&](uint32_t a, uint32_t b) {
    return groups[a].first_source < groups[b].first_source;
  });
}

}  // namespace

// Greedy from the strongest light on. Lights of share r of all light need N ~ r^3/2 samples, so
// certifying a light of share s saves dN/dr s of them.
void choose_lights(const LightGroups& groups, const ClusterBall& ball, size_t hits,
                   const DrawingBudget& budget, ClusterLights& out) {
  const uint32_t n = groups.size();
  groups.estimate(ball, out.estimates, out.near);
  out.is_certified.assign(n, 0);
  out.certified.clear();
  out.draws = budget.draws;
  out.sequence = 0;
  if (budget.draws > 0 && (budget.effort_divisor > 1 || !groups.are_many())) return;
  out.order.clear();
  double total = 0;
  for (uint32_t g = 0; g < n; ++g) total += double(out.estimates[g]);
  const bool are_all = !groups.are_many();
  const float points = points_of_pixel(1, budget.error);
  const float cost = float(cost_of_pair + cost_of_cluster / double(hits));
  // least share that pays, at r = 1
  const float least = 2.0f / 3 * cost * budget.viewing_rays / points;
  for (uint32_t g = 0; g < n; ++g)
    if (groups[g].first_source < groups[g].last_source && out.estimates[g] > 0 &&
        (are_all || double(out.estimates[g]) > double(least) * total))
      out.order.push_back(g);
  std::sort(out.order.begin(), out.order.end(), [&](uint32_t a, uint32_t b) {
    return out.estimates[a] != out.estimates[b] ? out.estimates[a] > out.estimates[b] : a < b;
  });
  double rest = total;
  for (const uint32_t g : out.order) {
    const double e = double(out.estimates[g]);
    if (!are_all && e * std::sqrt(rest / total) <= double(least) * total) break;
    out.is_certified[g] = 1;
    rest -= e;
  }
  rest = 0;
  for (uint32_t g = 0; g < n; ++g)
    if (out.is_certified[g] != 0)
      out.certified.push_back(g);
    else if (groups[g].first_source == groups[g].last_source || !are_all)
      rest += double(out.estimates[g]);
  sort_by_sources(groups, out.certified);
  const float of_pixel = rest > 0 ? points_of_pixel(float(rest / total), budget.error) : 0;
  out.draws = uint32_t(std::ceil(std::min(of_pixel / budget.viewing_rays, most_draws)));
}

bool certify_all(const LightGroups& groups, ClusterLights& out) {
  out.certified.clear();
  bool are_others = false;
  for (uint32_t g = 0; g < groups.size(); ++g) {
    const bool is_certified =
        groups[g].first_source < groups[g].last_source && out.estimates[g] > 0;
    out.is_certified[g] = is_certified ? 1 : 0;
    if (is_certified) out.certified.push_back(g);
    are_others = are_others || (!is_certified && out.estimates[g] > 0);
  }
  sort_by_sources(groups, out.certified);
  return are_others;
}

void certify_none(ClusterLights& out) {
  out.is_certified.assign(out.is_certified.size(), 0);
  out.certified.clear();
}

ClusterBall ball_about(const WaitingHits& hits, std::span<const uint32_t> members) {
  Box box;
  ClusterBall ball;
  ball.normal = hits.receivers[members[0]].normal;
  const Vec3 first = ball.normal;
  for (const uint32_t m : members) {
    const ShadowReceiver& r = hits.receivers[m];
    box.grow(r.position);
    if (length_squared(r.normal - first) > 1e-10f || length_squared(r.horizon - first) > 1e-10f)
      ball.normal = {};
  }
  ball.centre = box.centre();
  ball.radius = 0.5f * box.diagonal();
  // Receivers with a common normal need not lie in one plane.
  for (const uint32_t m : members)
    ball.depth = std::max(ball.depth, dot(ball.normal, ball.centre - hits.receivers[m].position));
  return ball;
}

void DrawnLightsScratch::resize(size_t n) {
  numbers.resize(3 * n);
  for (auto* a : {&u, &v, &pmfs, &places}) a->resize(n);
  for (auto* a : {&samples, &primitives, &hits, &chosen}) a->resize(n);
  streams.resize(n);
  receivers.resize(n);
  points.resize(n);
  is_valid.resize(n);
}

namespace {

// Number of samples per block.
constexpr size_t block = 1024;

struct Drawing {
  const DrawnLights& world;
  const LightGroups& groups;
  const WaitingHits& hits;
  const ClusterLights& lights;
  DrawnLightsScratch& s;

  void of_members(std::span<uint32_t> members, const std::vector<float>& estimates,
                  const std::vector<float>& near);
  bool set_groups(const std::vector<float>& estimates, const std::vector<float>& near);
  void choose(std::span<const uint32_t> members, size_t first);
  void connect(size_t n);
  Rgb value(uint32_t draw) const;
};

// Collects the groups to sample. Returns false if near groups matter so much that the cluster
// should be halved.
bool Drawing::set_groups(const std::vector<float>& estimates, const std::vector<float>& near) {
  s.of_groups.clear();
  s.groups.clear();
  float sum = 0, of_near = 0;
  for (uint32_t g = 0; g < groups.size(); ++g) {
    if (lights.is_certified[g] != 0 || !(estimates[g] > 0)) continue;
    sum += estimates[g];
    of_near += near[g];
    s.of_groups.push_back(estimates[g]);
    s.groups.push_back(g);
  }
  return of_near <= 0.1f * sum;
}

// Sets streams, samples, hits, receivers, primitives, pmfs, places, u and v for the draws of these
// hits. first: index of the first hit in s.shares.
void Drawing::choose(std::span<const uint32_t> members, size_t first) {
  const size_t n = members.size() * lights.draws;
  s.resize(n);
  size_t i = 0;
  for (const uint32_t m : members)
    for (uint32_t j = 0; j < lights.draws; ++j, ++i) {
      s.streams[i] = lights.sequence == 0 ? hits.draw_streams[m]
                                          : hash_combine(hits.draw_streams[m], lights.sequence);
      s.samples[i] = hits.samples[m] * lights.draws + j;
      s.hits[i] = m;
      s.receivers[i] = hits.receivers[m].position;
    }
  sobol_groups(s.streams.data(), s.samples.data(), n, 0, 3, s.numbers.data());
  for (i = 0; i < n; ++i) {
    const std::span<const float> sums = s.shares.sums(first + i / lights.draws);
    const float place = s.numbers[2 * n + i], all = sums.back();
    // Stay below the last sum, so that rounding cannot select a group of share zero.
    const float target = std::min(place * all, std::nextafter(all, 0.0f));
    const auto k = size_t(std::upper_bound(sums.begin(), sums.end(), target) - sums.begin());
    const float before = k == 0 ? 0.0f : sums[k - 1], own = sums[k] - before;
    float left = std::clamp((target - before) / own, 0.0f, one_minus_epsilon), pmf = 1;
    s.places[i] = place;
    s.chosen[i] = s.groups[k];
    s.primitives[i] = groups.choose_primitive(s.groups[k], left, pmf);
    s.pmfs[i] = pmf * (own / all);
    s.u[i] = s.numbers[i];
    s.v[i] = s.numbers[n + i];
  }
}

// Returns a ray that ends just before a point of a light, as shadow_ray_to() does.
Ray ray_between(const ShadowReceiver& r, const LightSample& light) {
  Ray ray;
  ray.origin = r.origin;
  const Vec3& p = light.point;
  const float magnitude =
      std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z), std::abs(r.position.x),
                std::abs(r.position.y), std::abs(r.position.z)});
  ray.direction = ended_before_light(p - ray.origin, light.normal, 2 * ray_offset(magnitude));
  ray.t_max = 1;
  return ray;
}

// BRDF × cosine towards draw i, times the MIS weight for rough lobes.
Rgb Drawing::value(uint32_t i) const {
  const uint32_t m = s.hits[i];
  const LightSample& light = s.points[i];
  const ShadowReceiver& r = hits.receivers[m];
  const float cosine = dot(light.wi, r.normal);
  if (!(cosine > 0) || !(dot(light.wi, r.horizon) > 0)) return {};
  if (hits.glossy[m] < 0) return Rgb{cosine};
  const GlossyHit& hit = hits.glossy_hits[size_t(hits.glossy[m])];
  const NominalSourceDensity& competitor = world.competition;
  const LightGroup& g = groups[s.chosen[i]];
  if (g.first_source == g.last_source)
    return glossy_value(hit, light.wi, competitor.density(s.primitives[i], hit.place, light.wi));
  for (uint32_t k = g.first_source; k < g.last_source; ++k)
    if (world.sources[k].is_back != light.is_front)
      return glossy_value(hit, light.wi, competitor.density(world.sources[k], hit.place, light.wi));
  return {};
}

void Drawing::connect(size_t n) {
  const PreparedScene& scene = world.scene;
  sample_many(scene.scene, scene.primitives, n, s.primitives.data(), s.receivers.data(), s.u.data(),
              s.v.data(), s.points.data(), s.is_valid.data(), s.light_samples);
  for (size_t i = 0; i < n; ++i) {
    const uint32_t m = s.hits[i];
    DrawnLightsScratch::Draw& d = s.draws.emplace_back();
    d = {m, s.places[i], {}, -1, {}};
    if (s.is_valid[i] == 0) continue;
    const LightSample& light = s.points[i];
    const float density = light.pdf_solid_angle * s.pmfs[i] * float(lights.draws);
    d.light = hits.weights[m] * light.radiance * value(uint32_t(i)) * (1 / density);
    if (d.light.is_black()) continue;
    d.ray = int32_t(s.rays.size());
    s.rays.push_back(ray_between(hits.receivers[m], light));
  }
}

// Halves clusters that are wide relative to the distance of lights that matter, else samples the
// cluster.
void Drawing::of_members(std::span<uint32_t> members, const std::vector<float>& estimates,
                         const std::vector<float>& near) {
  constexpr size_t fewest = 16;  // smallest part of a halved cluster
  const bool is_narrow = set_groups(estimates, near);
  if (s.groups.empty()) return;
  if (!is_narrow && members.size() >= 2 * fewest) {
    Box box;
    for (const uint32_t m : members) box.grow(hits.positions[m]);
    const Vec3 e = box.extent();
    const size_t axis = e.x >= e.y && e.x >= e.z ? 0 : e.y >= e.z ? 1 : 2;
    const size_t half = members.size() / 2;
    std::nth_element(members.begin(), members.begin() + std::ptrdiff_t(half), members.end(),
                     [&](uint32_t a, uint32_t b) {
                       const float p = hits.positions[a][axis], q = hits.positions[b][axis];
                       return p != q ? p < q : a < b;
                     });
    for (const std::span<uint32_t> side : {members.first(half), members.subspan(half)}) {
      std::sort(side.begin(), side.end());
      groups.estimate(ball_about(hits, side), s.estimates, s.near);
      of_members(side, s.estimates, s.near);
    }
    return;
  }
  s.shares.set(groups, world.sources, hits, members, s.groups, s.of_groups);
  const size_t at_a_time = std::max<size_t>(block / lights.draws, 1);
  for (size_t first = 0; first < members.size(); first += at_a_time) {
    const auto some = members.subspan(first, std::min(at_a_time, members.size() - first));
    for (size_t i = 0; i < some.size(); ++i)
      if ((first == 0 && i == 0) || hits.pixels[some[i]] != hits.pixels[members[first + i - 1]])
        s.runs.push_back(s.draws.size() + i * lights.draws);
    choose(some, first);
    connect(some.size() * lights.draws);
  }
}

// Sorts terms by place. Places are spread evenly over [0,1), so a bucket for each leaves little to
// sort.
void sort_terms(DrawnLightsScratch& s) {
  const size_t n = s.terms.size();
  const auto bucket_of = [n](const std::pair<float, float>& term) {
    return std::min(size_t(term.first * float(n)), n - 1);
  };
  s.begins.assign(n + 1, 0);
  for (const auto& term : s.terms) ++s.begins[bucket_of(term) + 1];
  for (size_t i = 1; i <= n; ++i) s.begins[i] += s.begins[i - 1];
  s.sorted.resize(n);
  for (const auto& term : s.terms) s.sorted[s.begins[bucket_of(term)]++] = term;
  s.terms.swap(s.sorted);
  for (size_t i = 1; i < n; ++i)
    for (size_t k = i; k > 0 && s.terms[k] < s.terms[k - 1]; --k)
      std::swap(s.terms[k], s.terms[k - 1]);
}

// Adds the variance of a run's sum. Sorted by light, samples are strata of equal probability, so
// half the squared differences of neighbours estimate it. Samples of one pixel share a sequence.
void add_variance(const WaitingHits& hits, std::span<const DrawnLightsScratch::Draw> run,
                  DrawnLightsScratch& s, RadianceBatch& out) {
  s.terms.clear();
  for (const auto& d : run) {
    if (hits.is_direct[d.hit] == 0) continue;
    const bool arrives = d.ray >= 0 && s.is_occluded[size_t(d.ray)] == 0;
    s.terms.emplace_back(d.place, (arrives ? luminance(d.light) : 0.0f) - luminance(d.expected));
  }
  if (s.terms.empty()) return;
  sort_terms(s);
  const auto n = float(s.terms.size());
  float squares = 0;
  for (size_t i = 1; i < s.terms.size(); ++i)
    squares += sqr(s.terms[i].second - s.terms[i - 1].second);
  const float variance = n > 1 ? 0.5f * squares * n / (n - 1) : sqr(s.terms[0].second);
  for (const auto& d : run)
    if (hits.is_direct[d.hit] != 0) out.direct_variance[hits.indices[d.hit]] += variance / n;
}

}  // namespace

void draw_lights(const DrawnLights& world, const WaitingHits& hits, std::span<uint32_t> members,
                 const ClusterLights& lights, DrawnLightsScratch& s, RadianceBatch& out,
                 Counters& counters) {
  if (lights.draws == 0 || members.empty()) return;
  Drawing drawing{world, world.groups, hits, lights, s};
  drawing.of_members(members, lights.estimates, lights.near);
  for (const uint32_t m : members) {
    ++counters.mixed;
    if (hits.is_first[m] != 0) out.sources[hits.indices[m]] += Rgb{1, 0, 0};
  }
  if (s.rays.size() >= DrawnLightsScratch::most_rays)
    resolve_draws(world.scene, hits, s, out, counters);
}

void resolve_draws(const PreparedScene& scene, const WaitingHits& hits, DrawnLightsScratch& s,
                   RadianceBatch& out, Counters& counters) {
  s.is_occluded.resize(s.rays.size());
  scene.tracer.occluded(s.rays, s.is_occluded, Coherence::coherent, s.factors);
  for (auto& d : s.draws) {
    const uint32_t index = hits.indices[d.hit];
    Rgb light = d.expected * -1.0f;
    if (d.ray >= 0) {
      d.light *= s.factors[size_t(d.ray)];
      ++out.shadow_rays[index];
      if (s.is_occluded[size_t(d.ray)] == 0) {
        light += d.light;
        out.note_draw(hits.is_direct[d.hit] != 0, luminance(d.light));
      }
    }
    if (!light.is_black()) out.add(index, hits.is_direct[d.hit] != 0, light, 0);
  }
  if (!out.direct_variance.empty())
    for (size_t r = 0; r < s.runs.size(); ++r) {
      const size_t last = r + 1 < s.runs.size() ? s.runs[r + 1] : s.draws.size();
      if (last > s.runs[r])
        add_variance(hits, std::span(s.draws).subspan(s.runs[r], last - s.runs[r]), s, out);
    }
  counters.shadow_rays += s.rays.size();
  s.draws.clear();
  s.runs.clear();
  s.rays.clear();
}

}  // namespace troffer
