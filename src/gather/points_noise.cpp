#include "gather/points_noise.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/units.h"

namespace troffer {

namespace {

constexpr double most_times = 64;
// Limit of rays of rows, for memory.
constexpr double most_sample_rays = 1 << 24;

// Returns the rays of one set.
std::span<const PointRay> rays_of(const PointsSeen& points, size_t set) {
  const size_t begin = set == 0 ? 0 : points.end[set - 1];
  return std::span(points.seen).subspan(begin, points.end[set] - begin);
}

NoiseDraws sum_of(std::span<const PointRay> seen, const std::vector<NoiseDraws>& off) {
  NoiseDraws sum{};
  for (const PointRay& r : seen) add_draws(sum, r.weight, off[r.cell]);
  return sum;
}

// Mean square of the error of a point by the noise of cells: the product of what its two sets of
// rays see. The square of one set would be too large, because it contains the noise of its own few
// rays.
double mean_square(const PointsSeen& points, size_t p, const std::vector<NoiseDraws>& off) {
  const NoiseDraws first = sum_of(rays_of(points, PointsSeen::sets * p), off),
                   second = sum_of(rays_of(points, PointsSeen::sets * p + 1), off);
  double sum = 0;
  for (size_t k = 0; k < first.size(); ++k) sum += double(first[k]) * double(second[k]);
  return sum / (sqr(double(points.rays)) * draws_of_noise);
}

// Gather of a point that gets light by way of cells.
struct PointGathers {
  size_t point;
  double light;     // luminance of all light together
  double variance;  // variance of one gather ray
};

std::vector<PointGathers> gathers_of(const PointsSeen& points, const std::vector<float>& direct,
                                     const std::vector<Rgb>& light) {
  const double n = PointsSeen::sets * points.rays;
  std::vector<PointGathers> lit;
  for (size_t p = 0; p < direct.size(); ++p) {
    double sum = 0, squares = 0;
    for (const size_t set : {PointsSeen::sets * p, PointsSeen::sets * p + 1})
      for (const PointRay& r : rays_of(points, set)) {
        const double x = double(r.weight) * double(luminance(light[r.cell]));
        sum += x;
        squares += x * x;
      }
    const double all = double(direct[p]) + sum / n;
    if (sum > 0 && all > 0)
      lit.push_back({p, all, std::max(squares - sum * sum / n, 0.0) / (n - 1)});
  }
  return lit;
}

// Returns the weight of a variance: the mean of 1 / light² of the point and 1 / mean² of the list.
double weight_of(const PointGathers& g, double mean) {
  return 0.5 / sqr(g.light) + 0.5 / sqr(mean);
}

}  // namespace

PointsNoise noise_at_points(const PointsSeen& points, const std::vector<float>& direct,
                            const CellRows& rows, const std::vector<Rgb>& light,
                            const CellErrors& off, const GatheringPoints& how, uint64_t seed,
                            int threads) {
  TROFFER_CHECK(points.end.size() == PointsSeen::sets * direct.size());
  PointsNoise noise{.other_rays = how.other_rays};
  if (points.rays == 0) return noise;
  const std::vector<float> none(light.size(), 0);
  const std::vector<NoiseDraws> by_rows = rows.noise_draws(off.by_rows, none, seed, threads),
                                by_hits = rows.noise_draws(none, off.by_hits, seed, threads);
  const std::vector<PointGathers> lit = gathers_of(points, direct, light);
  if (lit.empty()) return noise;
  double mean = 0, deviations = 0;
  for (const PointGathers& g : lit) mean += g.light / double(lit.size());
  for (const PointGathers& g : lit)
    deviations += std::sqrt(weight_of(g, mean) * g.variance) / double(lit.size());
  for (const PointGathers& g : lit) {
    const double weight = weight_of(g, mean);
    // Neyman's allocation, as in samples_wanted() (render/point_plan.h).
    const double wanted =
        how.error > 0 ? std::sqrt(weight * g.variance) * deviations / sqr(how.error) : 0;
    const double rays = std::max(std::min(wanted, how.most_rays), how.rays);
    noise.gather_rays += rays;
    noise.by_gather += weight * g.variance / rays / double(lit.size());
    noise.by_rows += weight * mean_square(points, g.point, by_rows) / double(lit.size());
    noise.by_hits += weight * mean_square(points, g.point, by_hits) / double(lit.size());
  }
  for (double* v : {&noise.by_rows, &noise.by_hits}) *v = std::max(*v, 0.0);
  return noise;
}

double times_as_many_rays(const PointsNoise& noise, double rays_of_rows) {
  const double others = noise.by_gather + noise.by_hits;
  if (!(rays_of_rows > 0) || !(noise.by_rows > 0) || !(others > 0)) return 1;
  const double of_points = noise.gather_rays + noise.other_rays;
  const double times = std::sqrt(of_points * noise.by_rows / (rays_of_rows * others));
  return std::max(std::min({times, most_times, most_sample_rays / rays_of_rows}), 1.0);
}

}  // namespace troffer
