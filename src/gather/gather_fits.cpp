// What records make of one another's gathers: how many rays they want, and linear fits.
#include "gather/gather_pass.h"

#include <algorithm>
#include <cmath>

namespace troffer {

namespace {

constexpr float unit = 16;  // rays of a neighbour of weight 1 in fits
// Gathers that follow a curve on one sequence of numbers err by less, together, than as many
// independent ones, as which their spread counts them (measured: docs/cells.md).
constexpr double gain_of_order = 2;
// Beyond this radius the fit's own error is more than it saves.
constexpr float far_radius = 0.12f;
constexpr float least_pixels = 1.5f;
// Fits hold within this share of the distance, times the root of the asked error; at most so far.
constexpr float reach_of_error = 2, most_reach = 0.2f;
// A lobe of this width or more shows what changes no faster than irradiance does: one over it.
constexpr float full_width = 2;
// Where neighbours are too few for a plane, their mean holds in their midst alone: no farther from
// it than this share of the distance, times the asked error.
constexpr double most_offset = 0.5;
// Neighbours on either side that a fit looks at, of those within its radius.
constexpr int few_along = 4, many_along = 8;

// Which half of the pixels this one is of (the sequence of Thue and Morse, along either axis): of
// any 3 × 3, and of those at any stride, there are about as many of either.
int half_of(int x, int y) {
  uint32_t v = uint32_t(x) ^ uint32_t(y);  // of the parity of all their bits together
  for (const int shift : {16, 8, 4, 2, 1}) v ^= v >> shift;
  return int(v & 1);
}

}  // namespace

// Whether the pixels around see something that stands before the record's surface, no farther from
// it than a few pixels are apart, and turns its back on it: a panel a finger's breadth below a
// ceiling. Behind its edge light changes by less than a pixel's width, whatever the record's few
// rays saw of it. (In a corner, surfaces see one another, and light goes over into the dark
// evenly.)
bool GatherPass::is_beside(int x, int y, uint32_t r) const {
  constexpr float close = 3, least_height = 0.03f;
  const GatherRecord& at = out_.records_[r];
  const auto around = [&](const auto& visit) {
    for (int j = y - 1; j <= y + 1; ++j)
      for (int i = x - 1; i <= x + 1; ++i)
        out_.of_pixel(i, j, [&](uint32_t o) {
          const GatherRecord& n = out_.records_[o];
          visit(n.hit, n.hit.position - at.hit.position);
        });
  };
  float apart2 = sqr(at.spacing);
  around([&](const CellHit& hit, const Vec3& d) {
    if (is_one_surface(at.hit, hit, at.spacing))
      apart2 = std::max(apart2, std::min(length_squared(d), sqr(16 * at.spacing)));
  });
  bool found = false;
  around([&](const CellHit& hit, const Vec3& d) {
    found |= dot(d, at.hit.horizon) > least_height * at.spacing && dot(d, hit.horizon) >= 0 &&
             length_squared(d) < sqr(close) * apart2 && !is_one_surface(at.hit, hit, at.spacing);
  });
  return found;
}

// Whether what one gathers says something of the other.
bool GatherPass::is_neighbour(uint32_t r, uint32_t o, Part part) const {
  const GatherRecord &at = out_.records_[r], &n = out_.records_[o];
  if (part == &GatherRecord::gloss && n.place.material != at.place.material) return false;
  return is_one_surface(at.hit, n.hit, at.spacing);
}

// Rays count for as much as there are, so that records whose first rays chanced to meet something,
// which get more, do not weigh too much of it in. But where light itself calls for more rays (the
// dark beside a caustic, which it hardly reaches), places would count for more than others: so over
// what is usual around them, in their half of the pixels. What the other half has has been decided
// by what this one has met: it would count for less where that is bright.
float GatherPass::usual_rays(int x, int y, uint32_t r) const {
  float rays = 0, records = 0;
  const int half = half_of(x, y);
  for (int j = y - usual_pixels; j <= y + usual_pixels; ++j)
    for (int i = x - usual_pixels; i <= x + usual_pixels; ++i) {
      if (half_of(i, j) != half) continue;
      out_.of_pixel(i, j, [&](uint32_t o) {
        if (!is_neighbour(r, o, &GatherRecord::matte)) return;
        rays += out_.records_[o].rays;
        records += 1;
      });
    }
  return rays / std::max(records, 1.0f);
}

GatherPass::Surroundings GatherPass::around(int x, int y, uint32_t r, Part part,
                                            Asked asked) const {
  const GatherRecord& at = out_.records_[r];
  float nearness = 0, bright_nearness = 0, light = 0, rays = 0, variance = 0, records = 0;
  for (int j = y - 2; j <= y + 2; ++j)
    for (int i = x - 2; i <= x + 2; ++i)
      out_.of_pixel(i, j, [&](uint32_t o) {
        const GatherRecord& n = out_.records_[o];
        if (asked == Asked::other_half && half_of(i, j) == half_of(x, y)) return;
        if (n.rays == 0 || !is_neighbour(r, o, part)) return;
        const GatherSums& sums = n.*part;
        nearness += n.nearness;
        bright_nearness += sums.bright_nearness;
        light += luminance(sums.sum);
        rays += n.rays;
        const float mean = luminance(sums.sum) / n.rays;
        variance +=
            std::max(sums.squares / n.rays - mean * mean, 0.0f) * n.rays / (n.rays - 1) / unit;
        records += 1;
      });
  // Rays that bring much light tell more of how it changes than others do. What a narrower lobe
  // shows changes faster.
  const float width = part == &GatherRecord::gloss ? std::min(full_width * at.width, 1.0f) : 1.0f;
  return {
      std::max(nearness / std::max(rays, 1.0f), bright_nearness / std::max(light, 1e-30f)) / width,
      variance / std::max(records, 1.0f), records};
}

// Every how many pixels a fit looks at: from the lattice that all records are on where pixels are
// thinned at that lattice, from elsewhere at all four in turn.
int GatherPass::step_of(int x, int y, int step) const {
  if (step <= 1) return 1;
  if (!is_thinned_) return step;
  return is_on_lattice(x, y) ? (step + 1) / 2 * 2 : step | 1;
}

LinearFit GatherPass::fit(int x, int y, uint32_t r, Part part, float radius, int along,
                          Asked asked) const {
  const GatherRecord& at = out_.records_[r];
  const int pixels = std::clamp(int(std::ceil(radius / at.spacing)), 1, most_pixels);
  const int step = step_of(x, y, pixels / along);
  const Frame frame(at.hit.horizon);
  const float scale = 1 / radius;
  LinearFit sums;
  for (int j = -pixels / step; j <= pixels / step; ++j)
    for (int i = -pixels / step; i <= pixels / step; ++i) {
      if (asked == Asked::other_half && half_of(x + i * step, y + j * step) == half_of(x, y))
        continue;
      out_.of_pixel(x + i * step, y + j * step, [&](uint32_t o) {
        const GatherRecord& n = out_.records_[o];
        const Vec3 d = (n.hit.position - at.hit.position) * scale;
        const float d2 = length_squared(d);
        if (d2 >= 1 || (beside_[o] != 0 && o != r) || !is_neighbour(r, o, part)) return;
        sums.add(dot(d, frame.tangent), dot(d, frame.bitangent), 1 - d2,
                 n.rays / usual_rays_[o] * usual_rays_[r] / unit, (n.*part).sum / n.rays);
      });
    }
  return sums;
}

// Few neighbours do not tell how far they are spread; their rays do.
FittedLight GatherPass::solved(const LinearFit& fit, const Surroundings& s) {
  constexpr int enough = 12;
  FittedLight light;
  fit.solve(light);
  if (fit.count() < enough) light.spread = std::max(light.spread, double(s.variance));
  return light;
}

// Of the luminance of either sum's light, by that of all that the pixel sees there. around: that of
// the light, not by the record's own few rays: what is bright would get few more, what is dark
// beside it many.
float GatherPass::allowed_error(const GatherRecord& r, Part part, float around) const {
  const Part other = part == &GatherRecord::matte ? &GatherRecord::gloss : &GatherRecord::matte;
  const float own =
      around * (r.*part).weight + luminance((r.*other).sum) * (r.*other).weight / r.rays;
  const float weight = std::max((r.*part).weight, 1e-4f);
  return float(options_.error) * 0.5f * (own + float(options_.typical)) / weight + 1e-20f;
}

// By what the other half of the pixels has met. Were it by its own rays too, or by theirs and its
// own together, those would get no more that have chanced to miss what is small and bright, and
// what is looked at again would be what was found too bright: all in all too dark.
uint32_t GatherPass::further_rays(int x, int y, uint32_t r, Part part) const {
  const GatherRecord& at = out_.records_[r];
  Surroundings s = around(x, y, r, part, Asked::other_half);
  const bool are_others = s.records > 0;
  if (!are_others) s = around(x, y, r, part);
  const float radius =
      std::max(near_radius / std::max(s.nearness, 1e-20f), least_pixels * at.spacing);
  const FittedLight light = solved(fit(x, y, r, part, std::min(radius, most_pixels * at.spacing),
                                       few_along, are_others ? Asked::other_half : Asked::all),
                                   s);
  // Both halves share what they have in the end.
  const double sharers = are_others ? 2 : 1;
  const double wanted =
      light.spread / std::max(sharers * light.neighbours, 1.0) /
      sqr(gain_of_order * double(allowed_error(at, part, luminance(light.value))));
  if (!(wanted > 1)) return 0;
  const double rays = std::min(first_rays * (wanted - 1), double(most_rays - first_rays));
  return uint32_t(rays / 4 + 0.999) * 4;
}

// One of the sums, as far as the noise asks for, and no farther. Returns how far from there
// irradiance would be about linear.
float GatherPass::fit_part(int x, int y, uint32_t r, Part part, Fitted& fitted) const {
  const GatherRecord& at = out_.records_[r];
  const Surroundings s = around(x, y, r, part);
  const float distance = 1 / std::max(s.nearness, 1e-20f);
  const float least = least_pixels * at.spacing, most = most_pixels * at.spacing;
  float radius = std::clamp(near_radius * distance, least, most);
  const FittedLight light = solved(fit(x, y, r, part, radius, few_along), s);
  const double allowed = double(allowed_error(at, part, luminance(light.value)));
  const double excess = light.spread / std::max(light.neighbours, 1.0) / (allowed * allowed);
  radius *= float(std::clamp(std::sqrt(excess), 0.5, 2.0));
  radius = std::clamp(radius, least, std::clamp(far_radius * distance, least, most));
  const LinearFit all = fit(x, y, r, part, radius, many_along);
  const FittedLight fine = solved(all, s);
  const double noise = fine.spread / std::max(fine.neighbours, 1.0);
  // What is bent shows in a narrower fit, if its noise lets it: the error goes with the radius²
  const FittedLight narrow = solved(fit(x, y, r, part, 0.5f * radius, few_along), s);
  const double apart = double(luminance(narrow.value)) - double(luminance(fine.value));
  const double chance = 2 * narrow.spread / std::max(narrow.neighbours, 1.0);
  const double bend2 = std::max(apart * apart - chance, 0.0) * 16 / 9;
  const double half = double((at.*part).half) / double(at.rays);
  fitted.value = fine.value;
  fitted.error = float(std::sqrt(noise + bend2 + half * half));
  // Sent by where they lie, not by what they have met: were fits left out by their noise, those
  // would go that have met what is small and bright, and those that missed it would stay.
  fitted.is_one_sided = !all.is_plane() && all.offset() * double(radius) >
                                               most_offset * options_.error * double(distance);
  return distance;
}

// Of a pixel that shares nobody's.
float GatherPass::own_rays(int x, int y, uint32_t r, Part part) const {
  const GatherRecord& at = out_.records_[r];
  return unit * around(x, y, r, part).variance /
         sqr(allowed_error(at, part, luminance((at.*part).sum) / at.rays));
}

FittedRecord GatherPass::fitted(int x, int y, uint32_t r) const {
  const GatherRecord& at = out_.records_[r];
  FittedRecord f;
  Fitted matte, gloss;
  float distance = fit_part(x, y, r, &GatherRecord::matte, matte);
  if (at.place.is_there())
    distance = std::min(distance, fit_part(x, y, r, &GatherRecord::gloss, gloss));
  f.irradiance = matte.value;
  f.error = matte.error;
  f.gloss = gloss.value;
  f.gloss_error = gloss.error;
  // What it errs by elsewhere goes with the square of how far.
  const float reach =
      std::min(reach_of_error * std::sqrt(float(options_.error)), most_reach) * distance;
  f.is_alone = beside_[r] != 0 || matte.is_one_sided || gloss.is_one_sided;
  f.reach = at.spacing > reach || f.is_alone ? 0 : reach;
  f.rays = std::min(std::max(own_rays(x, y, r, &GatherRecord::matte),
                             at.place.is_there() ? own_rays(x, y, r, &GatherRecord::gloss) : 0.0f),
                    float(most_rays));
  return f;
}

}  // namespace troffer
