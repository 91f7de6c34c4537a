#include "integrate/points_noise.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/units.h"

namespace troffer {

namespace {

constexpr double most_times = 64;
// Memory.
constexpr double most_rays = 1 << 24;

// Of one set.
std::span<const PointRay> rays_of(const PointsSeen& points, size_t set) {
  const size_t begin = set == 0 ? 0 : points.end[set - 1];
  return std::span(points.seen).subspan(begin, points.end[set] - begin);
}

NoiseDraws sum_of(std::span<const PointRay> seen, const std::vector<NoiseDraws>& off) {
  NoiseDraws sum{};
  for (const PointRay& r : seen) add_draws(sum, r.weight, off[r.cell]);
  return sum;
}

// The mean square of what a point is off by. By what one set of rays sees, times what the other
// does: few rays that see one cell each are off by more than the point, which has many.
double mean_square(const PointsSeen& points, size_t p, const std::vector<NoiseDraws>& off) {
  const NoiseDraws first = sum_of(rays_of(points, PointsSeen::sets * p), off),
                   second = sum_of(rays_of(points, PointsSeen::sets * p + 1), off);
  double sum = 0;
  for (size_t k = 0; k < first.size(); ++k) sum += double(first[k]) * double(second[k]);
  return sum / (sqr(double(points.rays)) * draws_of_noise);
}

}  // namespace

PointsNoise noise_at_points(const PointsSeen& points, const std::vector<float>& direct,
                            const CellRows& rows, const std::vector<Rgb>& light,
                            const CellsOff& off, const GatheringPoints& how, int threads) {
  TROFFER_CHECK(points.end.size() == PointsSeen::sets * direct.size());
  PointsNoise noise;
  if (points.rays == 0) return noise;
  const double n = PointsSeen::sets * points.rays;
  const std::vector<float> none(light.size(), 0);
  const std::vector<NoiseDraws> by_rows = rows.noise_draws(off.by_rows, none, threads),
                                by_hits = rows.noise_draws(none, off.by_hits, threads);
  int lit = 0;
  for (size_t p = 0; p < direct.size(); ++p) {
    double sum = 0, squares = 0;
    for (const size_t set : {PointsSeen::sets * p, PointsSeen::sets * p + 1})
      for (const PointRay& r : rays_of(points, set)) {
        const double x = double(r.weight) * double(luminance(light[r.cell]));
        sum += x;
        squares += x * x;
      }
    const double all = double(direct[p]) + sum / n;
    if (!(sum > 0) || !(all > 0)) continue;
    ++lit;
    const double variance = std::max(squares - sum * sum / n, 0.0) / (n - 1) / sqr(all);
    const double wanted = how.error > 0 ? variance / sqr(how.error) : 0;
    const double rays = std::max(std::min(wanted, how.most_rays), how.rays);
    noise.gather_rays += rays;
    noise.by_gather += variance / rays;
    noise.by_rows += mean_square(points, p, by_rows) / sqr(all);
    noise.by_hits += mean_square(points, p, by_hits) / sqr(all);
  }
  if (lit == 0) return noise;
  for (double* v : {&noise.by_gather, &noise.by_rows, &noise.by_hits}) *v = std::max(*v / lit, 0.0);
  return noise;
}

double times_as_many_rays(const PointsNoise& noise, double rays_of_rows) {
  const double others = noise.by_gather + noise.by_hits;
  if (!(rays_of_rows > 0) || !(noise.by_rows > 0) || !(others > 0)) return 1;
  const double times = std::sqrt(noise.gather_rays * noise.by_rows / (rays_of_rows * others));
  return std::max(std::min({times, most_times, most_rays / rays_of_rows}), 1.0);
}

}  // namespace troffer
