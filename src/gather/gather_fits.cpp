#include "gather/gather_fits.h"

#include <algorithm>
#include <cmath>

#include "base/ablation.h"

namespace troffer {

namespace {

constexpr float unit = 16;  // rays of a neighbour of weight 1 in fits
// Factor by which gathers along one curve, on one random sequence, err less together than their
// spread suggests, which is that of independent ones. Measured: docs/log/cells.md.
constexpr double gain_of_order = 2;
// Largest radius of a fit, in harmonic mean distances. Beyond it the fit's bias exceeds the noise
// that it saves.
constexpr float far_radius = 0.12f;
// Least radius of a fit, in pixels.
constexpr float least_pixels = 1.5f;
// Distance from its record within which a fit holds, in harmonic mean distances: the first times
// the root of the asked error, at most the second.
constexpr float reach_of_error = 2, most_reach = 0.2f;
// Inverse of the lobe width from which on gloss changes no faster than irradiance.
constexpr float full_width = 2;
// Limits of neighbours that a fit reads on either side. Within its radius it skips pixels to keep
// them.
constexpr int few_along = 4, many_along = 8;

// Returns the half (0 or 1) that a pixel belongs to, by the Thue-Morse sequence along both axes. A
// block of 3 × 3 pixels at any stride contains about as many pixels of one half as of the other.
int half_of(int x, int y) {
  uint32_t v = uint32_t(x) ^ uint32_t(y);  // reduced to the parity of its bits
  for (const int shift : {16, 8, 4, 2, 1}) v ^= v >> shift;
  return int(v & 1);
}

}  // namespace

// True if pixels around see a surface that stands close before the record's, with its back to it,
// such as a panel a finger's breadth below a ceiling. "Close" means no farther than a few pixels
// are apart. Behind the edge of such a thing light changes within less than a pixel, whatever the
// record's few rays saw. Surfaces that see each other, as in a corner, do not count, because light
// changes gradually there.
bool GatherFits::is_behind_edge(int x, int y, uint32_t r) const {
  if (is_left_out<"behind edges">()) return false;
  constexpr float close = 3, least_height = 0.03f;
  const GatherRecord& at = records_.all()[r];
  const auto around = [&](const auto& visit) {
    for (int j = y - 1; j <= y + 1; ++j)
      for (int i = x - 1; i <= x + 1; ++i)
        records_.of_pixel(i, j, [&](uint32_t o) {
          const GatherRecord& n = records_.all()[o];
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

// True if the gather at one record also says something about the other.
bool GatherFits::is_neighbour(uint32_t r, uint32_t o, Part part) const {
  const GatherRecord &at = records_.all()[r], &n = records_.all()[o];
  if (part == &GatherRecord::gloss && n.place.material != at.place.material) return false;
  return is_one_surface(at.hit, n.hit, at.spacing);
}

// Returns the mean number of rays of records around, in the record's own half of the pixels. Fits
// weight a record by its rays over this mean.
// Records whose first rays met something bright by chance get more rays, so weights by rays reduce
// the effect of that chance. But light itself may call for more rays, as in the dark next to a
// caustic, and a whole region must not count for more. Hence the quotient.
// The numbers of rays in the other half follow from the results of this half. With them, a record
// would count for less where its own half is bright.
float GatherFits::usual_rays(int x, int y, uint32_t r) const {
  float rays = 0, records = 0;
  const int half = half_of(x, y);
  for (int j = y - usual_pixels; j <= y + usual_pixels; ++j)
    for (int i = x - usual_pixels; i <= x + usual_pixels; ++i) {
      if (half_of(i, j) != half) continue;
      records_.of_pixel(i, j, [&](uint32_t o) {
        if (!is_neighbour(r, o, &GatherRecord::matte)) return;
        rays += records_.all()[o].rays;
        records += 1;
      });
    }
  return rays / std::max(records, 1.0f);
}

GatherFits::Surroundings GatherFits::around(int x, int y, uint32_t r, Part part,
                                            Asked asked) const {
  const GatherRecord& at = records_.all()[r];
  float nearness = 0, bright_nearness = 0, light = 0, rays = 0, variance = 0, records = 0;
  for (int j = y - 2; j <= y + 2; ++j)
    for (int i = x - 2; i <= x + 2; ++i)
      records_.of_pixel(i, j, [&](uint32_t o) {
        const GatherRecord& n = records_.all()[o];
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
  // Rays that bring much light say more about how it changes. Narrow lobes show faster changes.
  const float width = part == &GatherRecord::gloss ? std::min(full_width * at.width, 1.0f) : 1.0f;
  return {
      std::max(nearness / std::max(rays, 1.0f), bright_nearness / std::max(light, 1e-30f)) / width,
      variance / std::max(records, 1.0f), records};
}

// Returns the stride at which a fit reads pixels. Under thinning all records that matter must be
// met: from the lattice the stride is even, so only lattice pixels are read. From elsewhere it is
// odd, so all four lattices take turns.
int GatherFits::step_of(int x, int y, int step) const {
  if (step <= 1) return 1;
  if (!is_thinned_) return step;
  return is_on_lattice(x, y) ? (step + 1) / 2 * 2 : step | 1;
}

LinearFit GatherFits::fit(int x, int y, uint32_t r, Part part, float radius, int along,
                          Asked asked) const {
  const GatherRecord& at = records_.all()[r];
  const int pixels = std::clamp(int(std::ceil(radius / at.spacing)), 1, most_pixels);
  const int step = step_of(x, y, pixels / along);
  const Frame frame(at.hit.horizon);
  const float scale = 1 / radius;
  LinearFit sums;
  for (int j = -pixels / step; j <= pixels / step; ++j)
    for (int i = -pixels / step; i <= pixels / step; ++i) {
      if (asked == Asked::other_half && half_of(x + i * step, y + j * step) == half_of(x, y))
        continue;
      records_.of_pixel(x + i * step, y + j * step, [&](uint32_t o) {
        const GatherRecord& n = records_.all()[o];
        const Vec3 d = (n.hit.position - at.hit.position) * scale;
        const float d2 = length_squared(d);
        if (d2 >= 1 || (behind_edge_[o] != 0 && o != r) || !is_neighbour(r, o, part)) return;
        sums.add(dot(d, frame.tangent), dot(d, frame.bitangent), 1 - d2,
                 n.rays / usual_rays_[o] * usual_rays_[r] / unit, (n.*part).sum / n.rays);
      });
    }
  return sums;
}

// With few neighbours the residual of a fit underestimates the variance, so the variance of their
// rays is a lower bound.
FittedLight GatherFits::solved(const LinearFit& fit, const Surroundings& s) {
  constexpr int enough = 12;
  FittedLight light;
  fit.solve(light);
  if (fit.count() < enough) light.spread = std::max(light.spread, double(s.variance));
  return light;
}

// Returns the allowed error of the luminance of one of the record's sums, from all light that the
// pixel sees there. `around` is the luminance of that sum, estimated from the neighbours. An
// estimate from the record's own few rays would give bright records few further rays and their dark
// neighbours many.
float GatherFits::allowed_error(const GatherRecord& r, Part part, float around) const {
  const Part other = part == &GatherRecord::matte ? &GatherRecord::gloss : &GatherRecord::matte;
  const float own =
      around * (r.*part).weight + luminance((r.*other).sum) * (r.*other).weight / r.rays;
  const float weight = std::max((r.*part).weight, 1e-4f);
  return float(options_.error) * 0.5f * (own + float(options_.typical)) / weight + 1e-20f;
}

// Returns the number of further rays of a record, decided by what the other half of the pixels has
// met. If its own rays took part, records that happened to miss a small bright thing would get no
// more rays. Only those that met it would be corrected. The picture would become too dark.
uint32_t GatherFits::further_rays(int x, int y, uint32_t r, Part part) const {
  const GatherRecord& at = records_.all()[r];
  Surroundings s = around(x, y, r, part, Asked::other_half);
  const bool are_others = s.records > 0;
  if (!are_others) s = around(x, y, r, part);
  const float radius =
      std::max(near_radius / std::max(s.nearness, 1e-20f), least_pixels * at.spacing);
  const FittedLight light = solved(fit(x, y, r, part, std::min(radius, most_pixels * at.spacing),
                                       few_along, are_others ? Asked::other_half : Asked::all),
                                   s);
  // The final fit uses the records of both halves, twice as many as this one.
  const double sharers = are_others ? 2 : 1;
  const double wanted =
      light.spread / std::max(sharers * light.neighbours, 1.0) /
      sqr(gain_of_order * double(allowed_error(at, part, luminance(light.value))));
  if (!(wanted > 1) || is_left_out<"further gather rays">()) return 0;
  const double rays = std::min(first_rays * (wanted - 1), double(most_rays - first_rays));
  return uint32_t(rays / 4 + 0.999) * 4;
}

uint32_t GatherFits::further_rays(int x, int y, uint32_t r) const {
  const uint32_t matte = further_rays(x, y, r, &GatherRecord::matte);
  if (!records_.all()[r].place.is_there()) return matte;
  return std::max(matte, further_rays(x, y, r, &GatherRecord::gloss));
}

// Fits one of the sums, over no larger radius than its noise needs. Returns the harmonic mean
// distance of what is around.
float GatherFits::fit_part(int x, int y, uint32_t r, Part part, Fitted& fitted) const {
  const GatherRecord& at = records_.all()[r];
  const Surroundings s = around(x, y, r, part);
  const float distance = 1 / std::max(s.nearness, 1e-20f);
  const float least = least_pixels * at.spacing, most = most_pixels * at.spacing;
  float radius = std::clamp(near_radius * distance, least, most);
  const FittedLight light = solved(fit(x, y, r, part, radius, few_along), s);
  const double allowed = double(allowed_error(at, part, luminance(light.value)));
  const double excess = light.spread / std::max(light.neighbours, 1.0) / (allowed * allowed);
  if (!is_left_out<"radius by noise">()) radius *= float(std::clamp(std::sqrt(excess), 0.5, 2.0));
  radius = std::clamp(radius, least, std::clamp(far_radius * distance, least, most));
  const FittedLight fine = solved(fit(x, y, r, part, radius, many_along), s);
  const double noise = fine.spread / std::max(fine.neighbours, 1.0);
  // The bias of a fit goes with radius². It is therefore 4/3 of what a fit of half the radius
  // differs by beyond its noise.
  const FittedLight narrow = solved(fit(x, y, r, part, 0.5f * radius, few_along), s);
  const double apart = double(luminance(narrow.value)) - double(luminance(fine.value));
  const double chance = 2 * narrow.spread / std::max(narrow.neighbours, 1.0);
  const double bend2 = std::max(apart * apart - chance, 0.0) * 16 / 9;
  const double half = double((at.*part).half) / double(at.rays);
  fitted.value = fine.value;
  fitted.error = float(std::sqrt(noise + bend2 + half * half));
  return distance;
}

// Returns the number of gather rays that a pixel needs if it shares none with its neighbours.
float GatherFits::own_rays(int x, int y, uint32_t r, Part part) const {
  const GatherRecord& at = records_.all()[r];
  return unit * around(x, y, r, part).variance /
         sqr(allowed_error(at, part, luminance((at.*part).sum) / at.rays));
}

FittedRecord GatherFits::fitted(int x, int y, uint32_t r) const {
  const GatherRecord& at = records_.all()[r];
  FittedRecord f;
  Fitted matte, gloss;
  float distance = fit_part(x, y, r, &GatherRecord::matte, matte);
  if (at.place.is_there())
    distance = std::min(distance, fit_part(x, y, r, &GatherRecord::gloss, gloss));
  f.irradiance = matte.value;
  f.error = matte.error;
  f.gloss = gloss.value;
  f.gloss_error = gloss.error;
  // Away from its record, the error of a fit goes with the square of the distance.
  const float reach =
      std::min(reach_of_error * std::sqrt(float(options_.error)), most_reach) * distance;
  f.is_alone = behind_edge_[r] != 0;
  f.reach = at.spacing > reach || f.is_alone ? 0 : reach;
  f.rays = std::min(std::max(own_rays(x, y, r, &GatherRecord::matte),
                             at.place.is_there() ? own_rays(x, y, r, &GatherRecord::gloss) : 0.0f),
                    float(most_rays));
  return f;
}

}  // namespace troffer
