#include "certified/cluster_lighting.h"

#include <algorithm>
#include <cmath>

#include "base/ablation.h"
#include "base/streams.h"
#include "certified/open_parts.h"
#include "shadow/pilot_rays.h"
#include "transport/costs.h"

namespace troffer {

namespace {

// Luminance at a hit of this weight that contributes 1 % of the picture's typical luminance. Errors
// of weaker light are invisible.
float luminance_floor(float weight, float typical) {
  constexpr float share = 0.01f;
  return weight > 0 ? std::min(share * typical / weight, 1e15f) : 0;
}

// Rays per hit so that the sky's light and the suns' light each err by `error`, relative to what
// arrives.
double rays_of_hit(const EnvironmentShare& share, bool has_suns, double error) {
  const double of_suns = std::sqrt(share.spread_of_sun) / (share.open * error);
  return rays_for_error(share.open_sky, error) + (has_suns ? std::pow(of_suns, 4.0 / 3) : 0.0);
}

}  // namespace

EnvironmentSamplerInputs environment_inputs(const PreparedScene& scene,
                                            const CertifiedSources& sources,
                                            const WaitingHits& hits) {
  const CertifiedEnvironment& e = sources.environment();
  return {scene, sources.competition(), hits, e.points, *e.occluders};
}

void ClusterLighting::add(std::span<const uint32_t> members) {
  DrawingBudget budget = budget_;
  budget.effort_divisor = s_.request.effort_divisor;
  budget.typical = s_.request.typical_luminance;
  choose_lights(sources_.groups(), ball_about(s_.hits, members), members.size(), budget, s_.chosen);
  const bool is_closed_off = std::all_of(members.begin(), members.end(),
                                         [&](uint32_t m) { return s_.is_closed_off[m] != 0; });
  if (is_closed_off) count_closed_off(members);
  const bool has_far =
      !is_closed_off && may_be_proved_far(members) && is_proof_of_far_worth(members);
  std::span<const float> seen;
  const bool are_all_drawn = budget.draws > 0 && budget.effort_divisor > 1;
  const bool may_be_drawn = budget.draws > 0 && !sources_.groups().are_many() &&
                            !is_left_out<"samples instead of proofs">();
  if (are_all_drawn || may_be_drawn) set_draws(members, budget.effort_divisor);
  if (may_be_drawn && !are_all_drawn) {
    certify_or_draw(members);
    s_.chosen.certified.clear();
  } else {
    draw(members);
  }
  if (has_far || !s_.chosen.certified.empty()) seen = certify(members, has_far);
  if (!is_closed_off && !has_far)
    cast_environment_rays(environment_inputs(scene_, sources_, s_.hits), members, s_.far, seen,
                          budget, s_.far_rays, out_, counters_);
}

// Adds the light of the sampled groups.
void ClusterLighting::draw(std::span<const uint32_t> members) {
  s_.drawing.assign(members.begin(), members.end());
  draw_lights({scene_, sources_.groups(), sources_.all(), sources_.competition()}, s_.hits,
              s_.drawing, s_.chosen, s_.drawn, out_, counters_);
}

// Adds the light of the certified groups and, with has_far, of all sky patches. Returns the light
// received per member, luminance × sr; empty if there are no requests.
std::span<const float> ClusterLighting::certify(std::span<const uint32_t> members, bool has_far) {
  s_.cluster.receivers.clear();
  s_.integrand.hits().clear();
  for (const uint32_t m : members) {
    s_.cluster.receivers.push_back(s_.hits.receivers[m]);
    s_.cluster.receivers.back().floor =
        luminance_floor(luminance(s_.hits.weights[m]), s_.request.typical_luminance);
    const int32_t g = s_.hits.glossy[m];
    s_.integrand.hits().push_back(
        {s_.hits.positions[m], g < 0 || s_.hits.glossy_hits[size_t(g)].is_low_variance
                                   ? nullptr
                                   : &s_.hits.glossy_hits[size_t(g)]});
  }
  set_requests(has_far);
  if (s_.cluster.requests.empty()) return {};
  s_.cluster.shadow.set(s_.cluster.receivers);
  const CertifiedCounters before = s_.cluster.memory.counters;
  certified_light(s_.cluster.shadow, s_.cluster.requests, &s_.integrand, s_.world, s_.options,
                  s_.cluster.memory,
                  [&](uint32_t request, std::span<const SourceVisibility> answers) {
                    add_answers(request, members, answers);
                  });
  const CertifiedCounters& after = s_.cluster.memory.counters;
  counters_.clusters += after.clusters - before.clusters;
  counters_.masks += after.masks - before.masks;
  counters_.mask_facets += after.mask_facets - before.mask_facets;
  counters_.points += after.points - before.points;
  DrawingBudget budget = budget_;
  budget.typical = s_.request.typical_luminance;
  sample_open_parts(
      {scene_, sources_.competition(), s_.hits, members, s_.cluster, s_.integrand.sources()},
      budget, s_.drawn, out_, counters_);
  return s_.cluster.memory.light;
}

// Sets the number of light samples per hit, and their random sequence.
void ClusterLighting::set_draws(std::span<const uint32_t> members, uint32_t effort_divisor) {
  const bool is_matte = budget_.matte_draw_factor > 1 &&
                        std::all_of(members.begin(), members.end(),
                                    [&](uint32_t m) { return s_.hits.glossy[m] < 0; });
  s_.chosen.draws =
      std::max(budget_.draws * (is_matte ? budget_.matte_draw_factor : 1) / effort_divisor, 1u);
  if (effort_divisor > 1)
    s_.chosen.sequence = stream::reduced_light_samples + 2 * effort_divisor + (is_matte ? 1 : 0);
  else if (is_matte)
    s_.chosen.sequence = stream::matte_light_samples;
}

// Certifies up to four hits and measures the cost; certifies the others too if that costs less than
// sampling. Unbiased: the probed hits decide only about the others, whose random numbers are
// independent.
void ClusterLighting::certify_or_draw(std::span<const uint32_t> members) {
  constexpr size_t few = 4;
  const auto draws = double(s_.chosen.draws), n = double(members.size());
  bool are_drawn = certify_all(sources_.groups(), s_.chosen);
  double rays = (cost_of_cluster / n + cost_of_pair) * double(s_.chosen.certified.size());
  s_.first.clear();
  s_.rest.clear();
  const size_t step = std::max<size_t>(members.size() / few, 1);
  for (size_t i = 0; i < members.size(); ++i)
    (rays <= draws && i % step == 0 && s_.first.size() < few ? s_.first : s_.rest)
        .push_back(members[i]);
  if (!s_.first.empty()) {
    if (are_drawn) draw(s_.first);
    const double before = cost_of_rays_and_masks(counters_);
    certify(s_.first, false);
    rays += (cost_of_rays_and_masks(counters_) - before) / double(s_.first.size());
  }
  if (rays > draws) {
    certify_none(s_.chosen);
    are_drawn = true;
  }
  if (are_drawn) draw(s_.rest);
  if (rays <= draws && !s_.rest.empty()) certify(s_.rest, false);
}

// Counts all sky patches as proved dark for these hits.
void ClusterLighting::count_closed_off(std::span<const uint32_t> members) {
  const size_t far = environment_.cells->all().size();
  counters_.dark_certified += members.size() * far;
  for (const uint32_t m : members)
    if (s_.hits.is_first[m] != 0) out_.sources[s_.hits.indices[m]] += Rgb{0, 0, float(far)};
}

bool ClusterLighting::may_be_proved_far(std::span<const uint32_t> members) {
  return std::all_of(members.begin(), members.end(), [&](uint32_t m) {
    return length(s_.hits.positions[m] - environment_.centre) <= environment_.reach;
  });
}

// True if proofs for sky patches are expected to cost less than rays to them. Always true for
// measuring points unless the scene seems closed: their proofs may take longer.
bool ClusterLighting::is_proof_of_far_worth(std::span<const uint32_t> members) {
  constexpr double cost_of_look = 4000;  // in rays: shaft and facet lists of all patches
  constexpr double cost_of_gloss = 4;    // in rays per sky patch, extra for a glossy hit
  // rays of a pixel's further viewing rays, relative to the first ones
  constexpr double share_of_further = 0.25;
  // Above the open share `open_enough`, proofs need more than cost_of_patch_proof rays per sky
  // patch to pay.
  constexpr double cost_of_patch_proof = 40, open_enough = 0.25;
  if (is_left_out<"sky by rays">()) return true;
  if (s_.far.seems_closed) return false;
  if (!s_.request.is_picture) return true;
  if (s_.far.is_behind_clutter && !is_left_out<"rays behind clutter">()) return false;
  const double rays =
      rays_of_hit(s_.far, environment_.points.suns() > 0, double(s_.options.mask_error));
  const size_t cells = sources_.all().size() - environment_.first_source;
  if (!is_left_out<"rays to open sky">() && s_.far.open > open_enough &&
      rays < cost_of_patch_proof * double(cells))
    return false;
  double all = 0, proofs = cost_of_look;
  for (const uint32_t m : members) {
    all += s_.hits.samples[m] < uint32_t(budget_.viewing_rays)
               ? rays
               : rays * share_of_further / s_.request.effort_divisor;
    if (s_.hits.glossy[m] >= 0) proofs += cost_of_gloss * double(cells);
  }
  return all > proofs;
}

void ClusterLighting::set_requests(bool has_far) {
  s_.cluster.requests.clear();
  s_.requested.clear();
  s_.integrand.sources().clear();
  s_.integrand.behind_panes().clear();
  s_.integrand.portals().clear();
  Box receivers;
  for (const ShadowReceiver& r : s_.cluster.receivers) receivers.grow(r.position);
  const auto add = [&](uint32_t i) {
    const CertifiedSource& source = sources_.all()[i];
    const Portal* portal = scene_.primitives[source.primitive].portal;
    const Portal::View view =
        portal == nullptr ? Portal::View::all : portal->view(receivers, source.flat.plane);
    if (view == Portal::View::none) return;
    const bool is_cut = view == Portal::View::some;
    const bool is_left =
        is_cut && !portal->is_framed(environment_.frame_reach, receivers, source.flat.plane);
    s_.integrand.portals().push_back(is_left ? portal : nullptr);
    LightRequest& r = s_.cluster.requests.emplace_back();
    if (is_cut) r.frame = environment_.frames[source.primitive];
    r.sphere = source.is_round ? &source.sphere : nullptr;
    r.flat = source.is_round ? nullptr : &source.flat;
    r.stream = source.stream;
    r.brightness = luminance(source.radiance);
    r.found = &s_.found[i];
    r.batch = s_.hits.receivers;
    if (source.far != nullptr) r.far = &environment_.scene;
    s_.requested.push_back(i);
    s_.integrand.sources().push_back(&source);
    if (!scene_.panes.is_empty())
      scene_.panes.between(receivers, source.bounds(), s_.integrand.behind_panes().emplace_back());
  };
  for (const uint32_t g : s_.chosen.certified)
    for (uint32_t i = sources_.groups()[g].first_source; i < sources_.groups()[g].last_source; ++i)
      add(i);
  if (!has_far) return;
  for (auto i = environment_.first_source; i < uint32_t(sources_.all().size()); ++i) add(i);
}

void ClusterLighting::add_answers(uint32_t request, std::span<const uint32_t> members,
                                  std::span<const SourceVisibility> answers) {
  const CertifiedSource& source = sources_.all()[s_.requested[request]];
  for (uint32_t i = 0; i < members.size(); ++i) {
    const SourceVisibility& a = answers[i];
    if (a.answer == ShadowAnswer::below) continue;
    count_answer(a, counters_);
    const uint32_t m = members[i], index = s_.hits.indices[m];
    if (a.rays > 0) out_.shadow_rays[index] += a.rays;
    const bool is_lit = a.answer == ShadowAnswer::lit, is_dark = a.answer == ShadowAnswer::dark;
    if (s_.hits.is_first[m] != 0)
      out_.sources[index] +=
          Rgb{is_lit || is_dark ? 0.0f : 1.0f, is_lit ? 1.0f : 0.0f, is_dark ? 1.0f : 0.0f};
    if (is_dark) continue;
    const bool has_value = s_.integrand.is_wanted(request, i);
    Rgb factor = has_value ? s_.hits.weights[m] : s_.hits.weights[m] * source.radiance;
    const int32_t g = s_.hits.glossy[m];
    if (g >= 0 && s_.hits.glossy_hits[size_t(g)].is_low_variance)
      factor *= low_variance_value(s_.hits.glossy_hits[size_t(g)], source, s_.hits.positions[m]);
    out_.add(index, s_.hits.is_direct[m] != 0,
             has_value ? factor * a.value : factor * (a.unoccluded * a.visible),
             has_value ? sqr(luminance(factor)) * a.value_variance
                       : sqr(luminance(factor) * a.unoccluded) * a.variance);
  }
}

}  // namespace troffer
