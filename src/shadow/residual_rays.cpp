#include "shadow/residual_rays.h"

#include <algorithm>

namespace troffer {

namespace {

// Variance per change from one ray to the next, in squares of one ray's light. Neighbouring strata
// that are open with probabilities p and q differ with probability p (1 - q) + q (1 - p) = p (1 -
// p) + q (1 - q) + (p - q)². Half the number of changes is therefore, on average, no less than the
// variance, except for half of that of the first and the last stratum.
constexpr float variance_of_change = 0.5f;

void add_light(const RayGroup& g, const TracedRays& traced, RayAnswer& a) {
  uint32_t free = 0, changes = 0;
  for (uint32_t i = g.first; i < g.first + g.count; ++i) {
    free += traced.is_free[i];
    changes += i > g.first && traced.is_free[i] != traced.is_free[i - 1];
  }
  const float ray = g.light / float(g.count);
  const auto spread = float(traced.tallies[g.source].spread());
  a.light = ray * float(free);
  a.light_variance = sqr(ray) * (spread + float(changes) * variance_of_change);
}

void add_value(const RayGroup& g, std::span<const Rgb> values, const TracedRays& traced,
               RayAnswer& a) {
  const auto n = float(g.count);
  Rgb sum;
  float varying = 0, squares = 0;  // luminances of free values, or of hidden ones
  for (uint32_t i = 0; i < g.count; ++i) {
    const Rgb& value = values[g.first_value + i];
    const bool is_free = traced.is_free[g.first + i] != 0;
    if (is_free) sum += value;
    if (is_free == g.is_difference) continue;
    varying += luminance(value);
    squares += sqr(luminance(value));
  }
  a.value = sum * (g.light / n);
  const float spread = std::max(squares - sqr(varying) / n, 0.0f);
  a.value_variance = sqr(g.light) * spread / (n * std::max(n - 1, 1.0f));
}

// True if both groups belong to masks of one receiver and cell.
bool is_same_pair(const RayGroup& a, const RayGroup& b) {
  return a.frame == b.frame && a.member == b.member && a.passes == b.passes &&
         a.has_values == b.has_values;
}

// Sets the variance of several masks of a pair. Each has its own shift and its own rays, so their
// spread estimates the error of masks and rays together. first: index of the first mask; the others
// follow it.
void set_pass_variance(std::span<const RayGroup> groups, size_t first,
                       std::span<RayAnswer> answers) {
  float sum = 0, squares = 0;
  for (size_t i = first; i < groups.size() && is_same_pair(groups[i], groups[first]); ++i) {
    sum += answers[i].light;
    squares += sqr(answers[i].light);
    answers[i].light_variance = 0;
  }
  const auto n = float(groups[first].passes);
  answers[first].light_variance =
      std::max(squares - sqr(sum) / n, 0.0f) * n / std::max(n - 1, 1.0f);
}

}  // namespace

std::span<const RayAnswer> cast_residual_rays(const RayQueue& queue, ShadowScene& scene,
                                              std::span<const float> allowed,
                                              const RayLimits& limits, size_t most_found,
                                              RayMemory& memory) {
  memory.answers.clear();
  if (queue.is_empty()) return {};
  plan_rays(queue, allowed, limits, memory.plan);
  trace_rays(queue.sources, memory.plan, scene, memory.traced);
  const std::span<const RayGroup> groups = memory.plan.groups;
  for (const RayGroup& g : groups) {
    RayAnswer& a = memory.answers.emplace_back();
    a.source = g.source;
    a.member = g.member;
    a.rays = g.count;
    if (g.count == 0) continue;
    if (g.has_values)
      add_value(g, queue.values, memory.traced, a);
    else
      add_light(g, memory.traced, a);
  }
  for (size_t i = 0; i < groups.size(); ++i)
    if (groups[i].passes > 1 && (i == 0 || !is_same_pair(groups[i - 1], groups[i])))
      set_pass_variance(groups, i, memory.answers);
  for (const RaySource& s : queue.sources) s.found->trim(most_found);
  return memory.answers;
}

}  // namespace troffer
