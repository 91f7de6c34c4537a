#include "certified/open_parts.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "base/streams.h"
#include "certified/environment_sample_counts.h"
#include "certified/environment_sampler.h"
#include "shadow/cell_points.h"

namespace troffer {

namespace {

// Factor on the number of samples, because visibility behind scattered facets is unordered
// (docs/method/certified-appendix.md, "Lights at infinity").
constexpr double clutter = 2;
// Least share of the light assumed to arrive when the number of samples is chosen.
constexpr double least_open = 0.02;

// Number of largest facets kept as candidates for occluding walls.
constexpr size_t most_large = 96;

double area_of(const Quad& q) {
  return 0.5 * length(cross(Vec3d(q[2]) - Vec3d(q[0]), Vec3d(q[3]) - Vec3d(q[1])));
}

class FarDrawing {
 public:
  FarDrawing(const OpenPartInputs& draws, DrawnLightsScratch& s)
      : d_(draws), left_(draws.cluster.memory.left), s_(s) {
    for (const UnsettledPart& part : left_) {
      points_.emplace_back(part.cell);
      const CertifiedSource& source = *d_.sources[part.request];
      brightness_.push_back(double(luminance(source.radiance)));
      unevenness_.push_back(double(source.far->unevenness));
    }
    expected_ = float(std::max(2 * d_.cluster.memory.far_open - 1, 0.0));
  }

  // Number of samples per pixel. N points of a Sobol sequence over light of which the share p
  // arrives err by about (p (1 - p))^½ N^-¾, relative to that light.
  double points_of_pixel(double error, double typical, double p) const {
    double of_left = 0, seen = 0;
    for (size_t i = 0; i < d_.members.size(); ++i) {
      of_left += left_of(i);
      seen += double(d_.cluster.memory.light[i]);
    }
    const double open = std::clamp(p, least_open, 1 - least_open);
    const double arrives = seen + open * of_left;
    const double counts =
        std::max(arrives, double(d_.members.size()) * typical_light(d_.hits, d_.members, typical));
    if (!(counts > 0)) return 0;
    return clutter * std::pow(of_left * std::sqrt(open * (1 - open)) / (error * counts), 4.0 / 3);
  }

  void of_member(size_t i, uint32_t n, uint32_t before, RadianceBatch& out) {
    const uint32_t m = d_.members[i];
    double all = 0;
    for (size_t p = 0; p < left_.size(); ++p) all += chance_of(p, i);
    if (!(all > 0)) return;
    set_numbers(m, n, before);
    if (expected_ > 0 && d_.hits.glossy[m] < 0) expect(i, out);
    for (uint32_t j = 0; j < n; ++j) {
      DrawnLightsScratch::Draw& draw = s_.draws.emplace_back();
      draw = {m, s_.numbers[2 * n + j], {}, -1, {}};
      const double target = double(draw.place) * all;
      double below = 0;
      size_t part = 0;
      for (; part + 1 < left_.size(); ++part) {
        const double own = chance_of(part, i);
        if (target < below + own) break;
        below += own;
      }
      if (chance_of(part, i) > 0)
        connect(draw, part, chance_of(part, i) / all * n, s_.numbers[j], s_.numbers[n + j]);
    }
  }

 private:
  double light_of(size_t part, size_t i) const {
    return brightness_[part] * double(left_[part].unoccluded[i]);
  }
  // Weight with which a part is chosen. Light alone would rarely choose a dim part that contains
  // something bright, and would then weight it heavily.
  double chance_of(size_t part, size_t i) const { return light_of(part, i) * unevenness_[part]; }
  double left_of(size_t i) const {
    double sum = 0;
    for (size_t p = 0; p < left_.size(); ++p) sum += light_of(p, i);
    return sum;
  }

  void set_numbers(uint32_t m, uint32_t n, uint32_t before) {
    s_.streams.assign(n, hash_combine(d_.hits.draw_streams[m], stream::open_sky_parts));
    s_.samples.resize(n);
    s_.numbers.resize(3 * size_t(n));
    for (uint32_t j = 0; j < n; ++j) s_.samples[j] = before + j;
    sobol_groups(s_.streams.data(), s_.samples.data(), n, 0, 3, s_.numbers.data());
  }

  // Adds the share of the unoccluded light that is expected to arrive: a control variate, whose
  // error the samples correct.
  void expect(size_t i, RadianceBatch& out) const {
    const uint32_t m = d_.members[i];
    Rgb sum;
    for (size_t p = 0; p < left_.size(); ++p)
      sum += d_.sources[left_[p].request]->radiance * left_[p].unoccluded[i];
    out.add(d_.hits.indices[m], d_.hits.is_direct[m] != 0, d_.hits.weights[m] * sum * expected_, 0);
  }

  // points: expected number of samples in the part.
  void connect(DrawnLightsScratch::Draw& draw, size_t part, double points, float u, float v) {
    const CertifiedSource& source = *d_.sources[left_[part].request];
    const ShadowReceiver& r = d_.hits.receivers[draw.hit];
    const Vec3d y = points_[part].at(u, v), x(r.position), d = y - x;
    const double distance = length(d);
    const Vec3 wi(d * (1 / distance));
    const float cosine = dot(wi, r.normal);
    const bool is_above = dot(wi, r.horizon) > 0;
    // The closed form for disks clips at the horizon of the shading normal only.
    if (!(cosine > 0) || !(is_above || source.flat.is_disk)) return;
    const Parallelogram& plane = source.flat.plane;
    const double steradians =
        dot(plane.normal, x - plane.origin) / distance * points_[part].area() / sqr(distance);
    const Rgb weight = d_.hits.weights[draw.hit] * float(steradians / points);
    if (expected_ > 0 && d_.hits.glossy[draw.hit] < 0)
      draw.expected = weight * source.radiance * (cosine * expected_);
    if (!is_above || !is_through_portal(d_.scene.primitives, source, r.position, wi)) return;
    draw.light = weight * far_radiance_of(source, Vec3(d)) * value(source, draw.hit, wi, cosine);
    if (draw.light.is_black()) return;
    draw.ray = int32_t(s_.rays.size());
    Ray ray;
    ray.origin = r.origin;
    ray.direction = wi;
    s_.rays.push_back(ray);
  }

  // BRDF × cosine, times the MIS weight for rough lobes.
  Rgb value(const CertifiedSource& source, uint32_t m, const Vec3& wi, float cosine) const {
    if (d_.hits.glossy[m] < 0) return Rgb{cosine};
    const GlossyHit& hit = d_.hits.glossy_hits[size_t(d_.hits.glossy[m])];
    return glossy_value(hit, wi, d_.competition.density(source, hit.place, wi));
  }

  const OpenPartInputs& d_;
  const std::vector<UnsettledPart>& left_;
  DrawnLightsScratch& s_;
  std::vector<CellPoints> points_;  // per part
  std::vector<double> brightness_, unevenness_;
  float expected_ = 0;  // share of matte hits' unoccluded light added as control variate
};

}  // namespace

LargeFacets large_facets(const Occluders& occluders) {
  std::vector<std::pair<double, uint32_t>> order;
  for (uint32_t i = 0; i < occluders.facet_count(); ++i) {
    order.emplace_back(-area_of(occluders.facet(i)), i);
    // Drops facets that cannot be among the largest from time to time; there may be millions.
    if (order.size() < 4 * most_large) continue;
    std::nth_element(order.begin(), order.begin() + std::ptrdiff_t(most_large), order.end());
    order.resize(most_large);
  }
  const size_t n = std::min(order.size(), most_large);
  std::partial_sort(order.begin(), order.begin() + std::ptrdiff_t(n), order.end());
  LargeFacets far;
  for (size_t i = 0; i < n; ++i)
    far.large.push_back({occluders.facet(order[i].second), order[i].second, false});
  return far;
}

void sample_open_parts(const OpenPartInputs& draws, const DrawingBudget& budget,
                       DrawnLightsScratch& s, RadianceBatch& out, Counters& counters) {
  if (draws.cluster.memory.left.empty()) return;
  FarDrawing drawing(draws, s);
  const double of_pixel = drawing.points_of_pixel(double(budget.error), double(budget.typical),
                                                  draws.cluster.memory.far_open);
  EnvironmentSampleCounts numbers(draws.hits, draws.members, budget, of_pixel,
                                  draws.cluster.memory.far_open);
  if (numbers.usual() == 0) return;
  for (size_t i = 0; i < draws.members.size(); ++i) {
    if (numbers.is_first_of_pixel(i)) {
      numbers.look_at_pixel(i);
      s.runs.push_back(s.draws.size());
    }
    uint32_t before = 0;
    const uint32_t n = numbers.of(i, before);
    drawing.of_member(i, n, before, out);
  }
  if (s.rays.size() >= DrawnLightsScratch::most_rays)
    resolve_draws(draws.scene, draws.hits, s, out, counters);
}

}  // namespace troffer
