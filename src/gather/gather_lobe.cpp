#include "gather/gather_lobe.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/ablation.h"
#include "base/units.h"
#include "gather/gather_walks.h"

namespace troffer {

namespace {

// Least share of lobe rays that is worth evaluating both densities.
constexpr float least_by_lobe = 0.03f;

// Returns the share a of lobe rays that minimises the variance of both parts together under even
// surroundings. With n rays, the matte part's variance is matte² / (1 - a) / n. That of gloss is
// about gloss² / ((1 - a) / m + a) / n, with m the second moment of cosine-distributed rays.
float best_share(float matte, float gloss, float m) {
  if (!(m > 1) || !(gloss > 0)) return 0;
  if (is_left_out<"gather rays by lobe">()) return 0;
  if (!(matte > 0)) return GatherLobe::most_by_lobe;
  const float more = gloss * std::sqrt(1 - 1 / m) / matte - 1 / m;
  if (!(more > 0)) return 0;
  const float share = more / (1 + more);
  return share < least_by_lobe ? 0 : std::min(share, GatherLobe::most_by_lobe);
}

}  // namespace

GatherLobe::GatherLobe(const Bsdf& specular, const Vec3& normal, const Vec3& wo, float matte,
                       float gloss)
    : specular_(specular), frame_(normal), wo_(wo) {
  const Rgb all = albedo(specular, wo.z);
  const auto inverse = [](float x) { return x > 0 ? 1 / x : 0.0f; };
  scale_ = {inverse(all.r), inverse(all.g), inverse(all.b)};
  by_lobe_ = best_share(matte, gloss, second_moment());
}

Rgb GatherLobe::share_of(const Vec3& direction) const {
  const Vec3 wi = frame_.to_local(direction);
  return wi.z > 0 ? evaluate(specular_, wo_, wi) * scale_ * (1 / wi.z) : Rgb{0};
}

// Second moment of share_of() over cosine-distributed rays, relative to the square of its mean,
// 1/pi. It is pi times the mean of share_of() over directions drawn by the lobe, of which four are
// evaluated.
float GatherLobe::second_moment() const {
  constexpr std::array<Vec2, 4> places{
      {{0.125f, 0.625f}, {0.375f, 0.125f}, {0.625f, 0.875f}, {0.875f, 0.375f}}};
  float sum = 0;
  for (const Vec2& u : places) {
    BsdfSample s;
    if (!sample(specular_, wo_, u.y, u, s) || !(s.wi.z > 0)) continue;
    sum += luminance(s.weight * scale_) *
           luminance(evaluate(specular_, wo_, s.wi) * scale_ * (1 / s.wi.z));
  }
  return pi_f * sum / float(places.size());
}

Vec3 GatherLobe::direction(const GatherDistribution& aim, const CellHit& at, Vec2 number,
                           float lobe_number, float& weight) const {
  if (by_lobe_ == 0) return aim.direction(at, number, weight);
  Vec3 world;
  float by_lobe = 0;
  if (number.x < by_lobe_) {
    number.x = std::min(number.x / by_lobe_, one_minus_epsilon);
    BsdfSample s;
    weight = 0;
    if (!sample(specular_, wo_, lobe_number, number, s) || !(s.wi.z > 0)) return at.normal;
    world = frame_.to_world(s.wi);
    by_lobe = s.pdf;
  } else {
    number.x = std::min((number.x - by_lobe_) / (1 - by_lobe_), one_minus_epsilon);
    world = aim.direction(at, number, weight);
    by_lobe = pdf(specular_, wo_, frame_.to_local(world));
  }
  const float by_cosine = std::max(dot(world, at.normal), 0.0f) * inv_pi_f;
  const float density = (1 - by_lobe_) * aim.density(at, world) + by_lobe_ * by_lobe;
  weight = by_cosine > 0 ? by_cosine / density : 0;
  return world;
}

float set_out(const CellHit& from, const GatherDistribution& aim, const GatherLobe& lobe,
              Walk& walk) {
  float weight = 1;
  const float which = lobe.by_lobe() > 0 ? lobe_number(walk) : 0;
  set_out(from, lobe.direction(aim, from, direction_number(walk), which, weight), walk);
  walk.throughput *= weight;
  return weight;
}

}  // namespace troffer
