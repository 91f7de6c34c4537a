#include "annual/annual.h"

#include <algorithm>
#include <cmath>

#include "annual/sensor_hours.h"
#include "base/units.h"

namespace troffer {

namespace {

// Gather rays of all sensors and replicates together, and their limits for one sensor and
// replicate. Measured: docs/log/annual.md.
constexpr size_t gather_rays = 1 << 20;
constexpr size_t least_rays = 16, most_rays = 256;
constexpr size_t sensors_at_a_time = 64;
constexpr double share_of_reflected = 0.6;  // of the progress

std::vector<CellHit> hits_of(const std::vector<MeasuringPlace>& places) {
  std::vector<CellHit> hits;
  for (const MeasuringPlace& p : places) hits.push_back({p.position, p.normal, p.normal, p.offset});
  return hits;
}

TransportRays rays_of(const AnnualOptions& options, size_t sensors) {
  TransportRays rays;
  const size_t n = options.rays_of_sensor > 0
                       ? (size_t(options.rays_of_sensor) + replicate_count - 1) / replicate_count
                       : std::clamp(gather_rays / replicate_count / std::max<size_t>(sensors, 1),
                                    least_rays, most_rays);
  rays.of_sensor = int(n);
  return rays;
}

// Sums over one sensor, for AnnualResult::relative_error.
struct ErrorSums {
  double squares = 0, errors = 0;
};

// Returns AnnualResult::relative_error_reflected.
double reflected_error(std::span<const ReflectedReplicate> reflected, size_t sensors,
                       size_t patches) {
  double squares = 0, errors = 0;
  std::vector<double> values(reflected.size());
  for (size_t s = 0; s < sensors; ++s)
    for (size_t p = 0; p < patches; ++p) {
      double mean = 0;
      for (size_t r = 0; r < values.size(); ++r) {
        values[r] = double(reflected[r].of(s)[p]);
        mean += values[r] / double(values.size());
      }
      squares += mean * mean;
      errors += sqr(with_spread(mean, values).error);
    }
  return squares > 0 ? std::sqrt(errors / squares) : 0;
}

HoursOfSensor mean_hours(const SensorHours& hours, ErrorSums& sums) {
  HoursOfSensor out;
  out.total.assign(hours.hours, 0);
  out.sun.assign(hours.hours, 0);
  out.error.assign(hours.hours, 0);
  constexpr double n = replicate_count;
  for (size_t h = 0; h < hours.hours; ++h) {
    double sum = 0, squares = 0, sun = 0;
    for (size_t r = 0; r < size_t(replicate_count); ++r) {
      sum += double(hours.total_of(r)[h]) / n;
      sun += double(hours.sun_of(r)[h]) / n;
    }
    for (size_t r = 0; r < size_t(replicate_count); ++r) {
      const double d = double(hours.total_of(r)[h]) - sum;
      squares += d * d;
    }
    const double variance = squares / (n - 1) / n;
    out.total[h] = float(sum);
    out.sun[h] = float(sun);
    out.error[h] = float(std::sqrt(variance));
    sums.squares += sum * sum;
    sums.errors += variance;
  }
  return out;
}

}  // namespace

AnnualResult compute_annual(const PreparedScene& scene, const std::vector<MeasuringPlace>& places,
                            const WeatherYear& year, const Compass& compass,
                            const AnnualOptions& options, const TakeHours& take,
                            const ProgressCallback& progress, const StopFlag& stop) {
  const auto tell = [&](double fraction) {
    if (progress) progress(fraction);
  };
  YearSkies skies =
      make_year_skies(year, options.subdivision, options.ground_reflectance, options.threads);
  YearTimes times = make_year_times(year, skies, options.occupancy);
  AnnualResult result{std::move(skies), std::move(times),
                      FigureTable(places.size(), size_t(replicate_count))};
  const std::vector<CellHit> hits = hits_of(places);
  const std::vector<ReflectedReplicate> reflected = reflected_light(
      scene, hits, year, compass, {rays_of(options, hits.size()), options.seed, options.threads},
      [&](double f) { tell(share_of_reflected * f); }, stop);
  if (reflected.size() < size_t(replicate_count)) {
    result.is_complete = false;
    return result;
  }
  for (const ReflectedReplicate& r : reflected) {
    result.cells = std::max(result.cells, r.cells);
    result.links = std::max(result.links, r.links);
    result.sources = std::max(result.sources, r.sources);
  }
  result.relative_error_reflected =
      reflected_error(reflected, hits.size(), result.skies.coarse.sky.size());
  const YearOfLight light{scene, year, result.skies, compass, reflected, options.seed};
  ErrorSums all;
  for (size_t first = 0; first < hits.size(); first += sensors_at_a_time) {
    const size_t count = std::min(sensors_at_a_time, hits.size() - first);
    std::vector<HoursOfSensor> means(count);
    std::vector<ErrorSums> sums(count);
    parallel_for(count, options.threads, [&](size_t i) {
      if (stop.load()) return;
      const size_t sensor = first + i;
      const SensorHours hours = sensor_hours(light, sensor, hits[sensor]);
      means[i] = mean_hours(hours, sums[i]);
      const auto figures = [&](std::span<const float> total, std::span<const float> sun) {
        return figures_of(total, sun, result.times, year.steps_per_hour, options.figures);
      };
      result.figures.at(sensor, 0) = figures(means[i].total, means[i].sun);
      for (size_t r = 0; r < size_t(replicate_count); ++r)
        result.figures.at(sensor, r + 1) = figures(hours.total_of(r), hours.sun_of(r));
    });
    if (stop.load()) {
      result.is_complete = false;
      return result;
    }
    for (size_t i = 0; i < count; ++i) {
      all.squares += sums[i].squares;
      all.errors += sums[i].errors;
      if (take) take(first + i, means[i]);
    }
    tell(share_of_reflected +
         (1 - share_of_reflected) * double(first + count) / double(hits.size()));
  }
  result.relative_error = all.squares > 0 ? std::sqrt(all.errors / all.squares) : 0;
  return result;
}

}  // namespace troffer
