// The member functions of CertifiedLights that light one cluster of hits: by certificates, or by
// sampled lights where those cost less.
#include <algorithm>

#include "base/streams.h"
#include "certified/certified_lights.h"
#include "certified/open_parts.h"

namespace troffer {

namespace {

// Luminance at a hit of this weight that contributes 1 % of the picture's typical luminance. Errors
// of weaker light are invisible.
float luminance_floor(float weight, float typical) {
  constexpr float share = 0.01f;
  return weight > 0 ? std::min(share * typical / weight, 1e15f) : 0;
}

// Costs of certificates in shadow rays. In this order: a cluster and source, a hit and source, a
// mask, a facet in a mask, and a point at which a glossy BRDF or a texture is evaluated.
constexpr double rays_of_gather = 12, rays_of_pair = 0.15, rays_of_mask = 0.3,
                 rays_of_facet = 1.0 / 12, rays_of_point = 0.3;

struct Counted {
  CertifiedCounters counters;
  uint64_t rays = 0;
};
// Cost of the masks and rays counted from `a` to `b`, in shadow rays.
double rays_between(const Counted& a, const Counted& b) {
  return double(b.rays - a.rays) + rays_of_mask * double(b.counters.masks - a.counters.masks) +
         rays_of_facet * double(b.counters.mask_facets - a.counters.mask_facets) +
         rays_of_point * double(b.counters.points - a.counters.points);
}

}  // namespace

void CertifiedLights::illuminate_cluster(std::span<const uint32_t> members,
                                         CertifiedLightsScratch& s, RadianceBatch& out,
                                         Counters& counters) const {
  DrawingBudget budget = budget_;
  budget.effort_divisor = s.request.effort_divisor;
  budget.is_picture = s.request.is_picture;
  choose_lights(groups_, ball_about(s.hits, members), members.size(), budget, s.chosen);
  const bool is_closed_off = std::all_of(members.begin(), members.end(),
                                         [&](uint32_t m) { return s.is_closed_off[m] != 0; });
  if (is_closed_off) count_closed_off(members, s, out, counters);
  const bool has_far =
      !is_closed_off && may_be_proved_far(members, s) && is_proof_of_far_worth(members, s, out);
  std::span<const float> seen;
  const bool are_all_drawn = budget.draws > 0 && budget.effort_divisor > 1;
  const bool may_be_drawn = budget.draws > 0 && !groups_.are_many();
  if (are_all_drawn || may_be_drawn) set_draws(members, budget.effort_divisor, s);
  if (may_be_drawn && !are_all_drawn) {
    certify_or_draw(members, s, out, counters);
    s.chosen.certified.clear();
  } else {
    draw(members, s, out, counters);
  }
  if (has_far || !s.chosen.certified.empty()) seen = certify(members, has_far, s, out, counters);
  if (!is_closed_off && !has_far)
    cast_environment_rays(far_draws(s), members, s.far, seen, budget, s.far_rays, out, counters);
}

// Adds the light of the sampled groups.
void CertifiedLights::draw(std::span<const uint32_t> members, CertifiedLightsScratch& s,
                           RadianceBatch& out, Counters& counters) const {
  s.drawing.assign(members.begin(), members.end());
  draw_lights({scene_, groups_, sources_, competition_}, s.hits, s.drawing, s.chosen, s.drawn, out,
              counters);
}

// Adds the light of the certified groups and, with has_far, of all sky patches. Returns the light
// received per member, luminance × sr; empty if there are no requests.
std::span<const float> CertifiedLights::certify(std::span<const uint32_t> members, bool has_far,
                                                CertifiedLightsScratch& s, RadianceBatch& out,
                                                Counters& counters) const {
  s.cluster.receivers.clear();
  s.integrand.hits().clear();
  for (const uint32_t m : members) {
    s.cluster.receivers.push_back(s.hits.receivers[m]);
    s.cluster.receivers.back().floor =
        luminance_floor(luminance(s.hits.weights[m]), s.request.typical_luminance);
    const int32_t g = s.hits.glossy[m];
    s.integrand.hits().push_back(
        {s.hits.positions[m], g < 0 || s.hits.glossy_hits[size_t(g)].is_low_variance
                                  ? nullptr
                                  : &s.hits.glossy_hits[size_t(g)]});
  }
  set_requests(s, has_far);
  if (s.cluster.requests.empty()) return {};
  s.cluster.shadow.set(s.cluster.receivers);
  certified_light(s.cluster.shadow, s.cluster.requests, &s.integrand, s.world, s.options,
                  s.cluster.memory,
                  [&](uint32_t request, std::span<const SourceVisibility> answers) {
                    add_answers(request, members, answers, s, out, counters);
                  });
  DrawingBudget budget = budget_;
  budget.is_picture = s.request.is_picture;
  sample_open_parts({scene_, competition_, s.hits, members, s.cluster, s.integrand.sources()},
                    budget, s.drawn, out, counters);
  return s.cluster.memory.light;
}

// Sets the number of light samples per hit, and their random sequence.
void CertifiedLights::set_draws(std::span<const uint32_t> members, uint32_t effort_divisor,
                                CertifiedLightsScratch& s) const {
  const bool is_matte =
      budget_.matte_draw_factor > 1 &&
      std::all_of(members.begin(), members.end(), [&](uint32_t m) { return s.hits.glossy[m] < 0; });
  s.chosen.draws =
      std::max(budget_.draws * (is_matte ? budget_.matte_draw_factor : 1) / effort_divisor, 1u);
  if (effort_divisor > 1)
    s.chosen.sequence = stream::reduced_light_samples + 2 * effort_divisor + (is_matte ? 1 : 0);
  else if (is_matte)
    s.chosen.sequence = stream::matte_light_samples;
}

// Certifies up to four hits and measures the cost; certifies the others too if that costs less than
// sampling. Unbiased: the probed hits decide only about the others, whose random numbers are
// independent.
void CertifiedLights::certify_or_draw(std::span<const uint32_t> members, CertifiedLightsScratch& s,
                                      RadianceBatch& out, Counters& counters) const {
  constexpr size_t few = 4;
  const auto draws = double(s.chosen.draws), n = double(members.size());
  bool are_drawn = certify_all(groups_, s.chosen);
  double rays = (rays_of_gather / n + rays_of_pair) * double(s.chosen.certified.size());
  s.first.clear();
  s.rest.clear();
  const size_t step = std::max<size_t>(members.size() / few, 1);
  for (size_t i = 0; i < members.size(); ++i)
    (rays <= draws && i % step == 0 && s.first.size() < few ? s.first : s.rest)
        .push_back(members[i]);
  if (!s.first.empty()) {
    if (are_drawn) draw(s.first, s, out, counters);
    const Counted before{s.cluster.memory.counters, counters.shadow_rays};
    certify(s.first, false, s, out, counters);
    const Counted after{s.cluster.memory.counters, counters.shadow_rays};
    rays += rays_between(before, after) / double(s.first.size());
  }
  if (rays > draws) {
    certify_none(s.chosen);
    are_drawn = true;
  }
  if (are_drawn) draw(s.rest, s, out, counters);
  if (rays <= draws && !s.rest.empty()) certify(s.rest, false, s, out, counters);
}

}  // namespace troffer
