#include "report/daylight_glare.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "report/glare.h"
#include "report/glare_regions.h"

namespace troffer {

namespace {

constexpr double low_light_lx = 1000;  // Ev below which the DGP is corrected [2]

// Sums over the picture's hemisphere.
struct Hemisphere {
  double solid_angle = 0, luminance = 0, vertical_lx = 0;  // ∫dω, ∫L dω, ∫L cos dω
};

Hemisphere hemisphere_of(const FisheyeGrid& grid, const Image& picture) {
  Hemisphere h;
  for (int y = 0; y < grid.side; ++y)
    for (int x = 0; x < grid.side; ++x) {
      const double w = grid.solid_angle(x, y);
      if (!(w > 0)) continue;
      const double l = double(picture.at(x, y).r);
      h.solid_angle += w;
      h.luminance += l * w;
      h.vertical_lx += l * w * grid.direction(x, y).z;
    }
  return h;
}

double mean_of_task(const FisheyeGrid& grid, const Image& picture, const GlareSettings& s) {
  const auto px = int(s.task->x), py = int(s.task->y);
  if (px < 0 || py < 0 || px >= grid.side || py >= grid.side || !(grid.solid_angle(px, py) > 0))
    throw UsageError("the task lies outside the picture");
  const Vec3d middle = grid.direction(px, py);
  double sum = 0, size = 0;
  for (int y = 0; y < grid.side; ++y)
    for (int x = 0; x < grid.side; ++x) {
      const double w = grid.solid_angle(x, y);
      if (!(w > 0) || dot(grid.direction(x, y), middle) < std::cos(s.task_rad / 2)) continue;
      sum += double(picture.at(x, y).r) * w;
      size += w;
    }
  return size > 0 ? sum / size : 0;
}

DaylightGlareSource source_of(const FisheyeGrid& grid, const Image& picture,
                              const GlareRegion& region) {
  DaylightGlareSource s;
  double x_sum = 0, y_sum = 0;
  for (const size_t k : region) {
    const int x = int(k % size_t(grid.side)), y = int(k / size_t(grid.side));
    const double w = grid.solid_angle(x, y), l = double(picture.at(x, y).r);
    s.solid_angle += w;
    s.luminance += l * w;
    s.illuminance += l * w * grid.direction(x, y).z;
    x_sum += x * w;
    y_sum += y * w;
  }
  s.pixels = region.size();
  s.luminance /= s.solid_angle;
  s.pixel = {float(x_sum / s.solid_angle), float(y_sum / s.solid_angle)};
  s.direction = grid.direction(x_sum / s.solid_angle, y_sum / s.solid_angle);
  s.position_index = wide_position_index(s.direction);
  return s;
}

double strength(const DaylightGlareSource& s) {
  return sqr(s.luminance / s.position_index) * s.solid_angle;
}

// 10 log10 Σ .478 L^1.6 Ω^.8 / (Lb + .07 ω^.5 L), Ω = ω / P² [3].
double daylight_glare_index(const std::vector<DaylightGlareSource>& sources, double background) {
  double sum = 0;
  for (const DaylightGlareSource& s : sources)
    sum += 0.478 * std::pow(s.luminance, 1.6) *
           std::pow(s.solid_angle / sqr(s.position_index), 0.8) /
           (background + 0.07 * std::sqrt(s.solid_angle) * s.luminance);
  return sum > 0 ? 10 * std::log10(sum) : 0;
}

double unified_glare_rating(const std::vector<DaylightGlareSource>& sources, double background) {
  double sum = 0;
  for (const DaylightGlareSource& s : sources) sum += strength(s);
  return sum > 0 && background > 0 ? 8 * std::log10(0.25 / background * sum) : 0;
}

}  // namespace

double daylight_glare_probability(double vertical_lx,
                                  const std::vector<DaylightGlareSource>& sources) {
  double sum = 0;
  for (const DaylightGlareSource& s : sources) sum += strength(s);
  const double contrast =
      vertical_lx > 0 ? 0.092 * std::log10(1 + sum / std::pow(vertical_lx, 1.87)) : 0;
  return std::min(5.87e-5 * vertical_lx + contrast + 0.159, 1.0);
}

double low_light_factor(double vertical_lx) {
  if (vertical_lx >= low_light_lx) return 1;
  const double e = std::exp(0.024 * vertical_lx - 4);
  return e / (1 + e);
}

DaylightGlare daylight_glare(const Image& picture, const GlareSettings& settings) {
  if (picture.width != picture.height || picture.width < 2)
    throw UsageError("the picture is not square: a fisheye of 180 degrees is needed");
  const FisheyeGrid grid{picture.width};
  const Hemisphere h = hemisphere_of(grid, picture);
  DaylightGlare out;
  out.vertical_lx = h.vertical_lx;
  out.mean_luminance = h.luminance / h.solid_angle;
  out.threshold = settings.threshold;
  if (settings.threshold <= 100)
    out.threshold *= settings.task ? mean_of_task(grid, picture, settings) : out.mean_luminance;
  for (const GlareRegion& region :
       glare_regions(grid, picture, out.threshold, settings.peak, settings.search_rad / 2))
    out.sources.push_back(source_of(grid, picture, region));
  std::stable_sort(out.sources.begin(), out.sources.end(),
                   [](const DaylightGlareSource& a, const DaylightGlareSource& b) {
                     return strength(a) > strength(b);
                   });
  double direct = 0;
  for (const DaylightGlareSource& s : out.sources) direct += s.illuminance;
  out.background_luminance = std::max(0.0, out.vertical_lx - direct) / pi;
  out.dgp = daylight_glare_probability(out.vertical_lx, out.sources);
  if (settings.corrects_low_light) out.dgp *= low_light_factor(out.vertical_lx);
  out.dgi = daylight_glare_index(out.sources, out.background_luminance);
  out.ugr = unified_glare_rating(out.sources, out.background_luminance);
  return out;
}

}  // namespace troffer
