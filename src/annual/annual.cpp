#include "annual/annual.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "annual/blinds.h"
#include "annual/eye_glare.h"
#include "annual/sensor_hours.h"
#include "annual/sensor_states.h"
#include "base/units.h"

namespace troffer {

namespace {

// Gather rays of all sensors and replicates together, and their limits for one sensor and
// replicate. Measured: docs/log/annual.md.
constexpr size_t gather_rays = 1 << 20;
constexpr size_t least_rays = 16, most_rays = 256;
constexpr size_t sensors_at_a_time = 64;
// Parts of the progress; the rest is for hours.
constexpr double share_of_reflected = 0.6, share_of_blinds = 0.1;

TransportRays rays_of(const AnnualOptions& options, size_t sensors) {
  TransportRays rays;
  const size_t n = options.rays_of_sensor > 0
                       ? (size_t(options.rays_of_sensor) + replicate_count - 1) / replicate_count
                       : std::clamp(gather_rays / replicate_count / std::max<size_t>(sensors, 1),
                                    least_rays, most_rays);
  rays.of_sensor = int(n);
  return rays;
}

ReflectedOptions reflected_options(const AnnualOptions& options, size_t sensors) {
  ReflectedOptions out;
  out.rays = rays_of(options, sensors);
  out.seed = options.seed;
  out.threads = options.threads;
  return out;
}

// Squares of coefficients and of their errors, for AnnualResult::relative_error_reflected.
void add_reflected_error(std::span<const ReflectedReplicate> reflected, size_t sensors,
                         size_t patches, ErrorSums& sums) {
  std::vector<double> values(reflected.size());
  for (size_t s = 0; s < sensors; ++s)
    for (size_t p = 0; p < patches; ++p) {
      double mean = 0;
      for (size_t r = 0; r < values.size(); ++r) {
        values[r] = double(reflected[r].of(s)[p]);
        mean += values[r] / double(values.size());
      }
      sums.squares += mean * mean;
      sums.errors += sqr(with_spread(mean, values).error);
    }
}

// One calculation, step by step. Each step returns false once `stop` is set.
class AnnualCalculation {
 public:
  AnnualCalculation(const AnnualRequest& request, const AnnualOptions& options,
                    const ProgressCallback& progress, const StopFlag& stop, AnnualResult& result)
      : request_(request),
        options_(options),
        progress_(progress),
        stop_(stop),
        result_(result),
        outside_{request.year, result.skies, request.compass, options.seed},
        states_(request.paths, request.points),
        families_(states_.families()) {}

  bool reflect() {
    ErrorSums sums;
    if (!reflect_families(share_of_reflected)) return false;
    subtract_fixed();
    for (size_t k = 0; k < states_.size(); ++k) {
      const LitState& state = states_[k];
      for (const ReflectedReplicate& r : state.reflected) {
        result_.cells = std::max(result_.cells, r.cells);
        result_.links = std::max(result_.links, r.links);
        result_.sources = std::max(result_.sources, r.sources);
      }
      add_reflected_error(state.reflected, state.hits.size(), result_.skies.coarse.sky.size(),
                          sums);
    }
    result_.relative_error_reflected = sums.squares > 0 ? std::sqrt(sums.errors / sums.squares) : 0;
    return true;
  }

  // Computes what is AnnualRequest::store's own share.
  bool reflect_share() { return reflect_families(1); }

  bool operate_blinds() {
    if (options_.blinds == "open" || !has_several_states(request_.paths)) return true;
    if (options_.blinds != "lm-83") {
      result_.schedule =
          read_state_schedule(options_.blinds, request_.paths, request_.year, result_.skies);
      return true;
    }
    std::vector<SunOfPath> sun(request_.paths.size());
    for (SunOfPath& s : sun) {
      s.open.resize(request_.points.size());
      s.closed.resize(request_.points.size());
    }
    parallel_for(request_.points.size(), options_.threads, [&](size_t s) {
      if (!stop_.load()) find_sun(s, sun);
    });
    if (stop_.load()) return false;
    tell(share_of_reflected + share_of_blinds);
    result_.schedule = lm83_schedule(request_.paths, sun, request_.grids, result_.skies.hours());
    return true;
  }

  bool take_hours(const TakeHours& take) {
    const size_t sensors = request_.points.size();
    const StateSums sums(states_, result_.schedule);
    ErrorSums all;
    for (size_t first = 0; first < sensors; first += sensors_at_a_time) {
      const size_t count = std::min(sensors_at_a_time, sensors - first);
      std::vector<HoursOfSensor> means(count);
      std::vector<ErrorSums> errors(count);
      parallel_for(count, options_.threads, [&](size_t i) {
        if (stop_.load()) return;
        means[i] = hours_of(sums, first + i, errors[i]);
      });
      if (stop_.load()) return false;
      for (size_t i = 0; i < count; ++i) {
        all.squares += errors[i].squares;
        all.errors += errors[i].errors;
        if (take) take(first + i, means[i]);
      }
      constexpr double before = share_of_reflected + share_of_blinds;
      tell(before + (1 - before) * double(first + count) / double(sensors));
    }
    result_.relative_error = all.squares > 0 ? std::sqrt(all.errors / all.squares) : 0;
    return true;
  }

 private:
  void tell(double fraction) const {
    if (progress_) progress_(fraction);
  }
  // Sets the reflected light of all states. share: of the progress.
  bool reflect_families(double share) {
    ReflectedOptions o = reflected_options(options_, request_.points.size());
    o.keeper = request_.store;
    size_t before = 0;
    for (const StateFamily& family : families_) {
      const size_t count = family.states.size();
      const auto tell_part = [&](double f) {
        tell(share * (double(before) + f * double(count)) / double(states_.size()));
      };
      std::vector<std::vector<ReflectedReplicate>> reflected =
          reflected_light(family, request_.year, request_.compass, o, tell_part, stop_);
      for (size_t i = 0; i < count; ++i) {
        if (reflected[i].size() < size_t(replicate_count)) return false;
        states_[family.states[i].number].reflected = std::move(reflected[i]);
      }
      before += count;
    }
    return true;
  }
  // Light by windows outside of all groups enters in every state, but counts once, in the first
  // one. What it brings there is subtracted in all states of groups. Otherwise it counted once per
  // group.
  bool has_fixed() const {
    return request_.paths[0].name == static_path && request_.paths.size() > 1;
  }
  bool is_of_group(size_t state) const { return has_fixed() && state >= states_.first_of(1); }
  void subtract_fixed() {
    for (size_t k = 0; k < states_.size(); ++k)
      for (size_t r = 0; is_of_group(k) && r < states_[k].reflected.size(); ++r) {
        const std::vector<float>& fixed = states_[0].reflected[r].coefficients;
        std::vector<float>& of_state = states_[k].reflected[r].coefficients;
        for (size_t i = 0; i < of_state.size(); ++i) of_state[i] -= fixed[i];
      }
  }
  // Calls visit(family, rays, fixed) for all families. fixed: what to subtract in states of groups.
  template <class Visit>
  void visit_rays(size_t sensor, DirectRays::Parts parts, const Visit& visit) const {
    std::vector<float> fixed;
    for (const StateFamily& family : families_) {
      const DirectRays rays(outside_, family, sensor, parts);
      if (fixed.empty() && has_fixed()) fixed = rays.open_in(family.states[0]);
      visit(family, rays, std::span<const float>(fixed));
    }
  }
  // Finds the sun of a sensor in the first and the last state of every path.
  void find_sun(size_t sensor, std::vector<SunOfPath>& sun) const {
    const auto visit = [&](const StateFamily& family, const DirectRays& rays,
                           std::span<const float> fixed) {
      for (const StateOfFamily& state : family.states)
        for (size_t p = 0; p < sun.size(); ++p) {
          const bool is_first = state.number == states_.first_of(p);
          const bool is_last = state.number + 1 == states_.first_of(p + 1);
          if (!is_first && !is_last) continue;
          std::vector<SunHour> hours =
              rays.sun_in(state, is_of_group(state.number) ? fixed : std::span<const float>());
          if (is_first) sun[p].open[sensor] = hours;
          if (is_last) sun[p].closed[sensor] = std::move(hours);
        }
    };
    visit_rays(sensor, DirectRays::Parts::sun, visit);
  }
  YearOfLight light_of(const LitState& state) const {
    return {*state.scene, outside_, state.reflected};
  }
  // Adds all hours of a sensor in the states of a family.
  void add_hours(const StateFamily& family, const DirectRays& rays, std::span<const float> fixed,
                 size_t sensor, StateSums::Sensor& sum) const {
    std::vector<YearOfLight> lights;
    std::vector<SensorHours> hours;
    lights.reserve(family.states.size());
    for (const StateOfFamily& s : family.states) {
      lights.push_back(light_of(states_[s.number]));
      const auto subtracted = is_of_group(s.number) ? fixed : std::span<const float>();
      hours.emplace_back(lights.back(), sensor, family.sensors[sensor], rays,
                         rays.open_in(s, subtracted));
    }
    RunOfHours run;
    const size_t all = result_.skies.hours();
    for (run.first = 0; run.first < all; run.first += RunOfHours::most) {
      run.count = std::min(RunOfHours::most, all - run.first);
      for (size_t i = 0; i < hours.size(); ++i) {
        hours[i].compute(run);
        sum.add(family.states[i].number, run);
      }
    }
  }
  void add_glare(size_t sensor, StateSums::Sensor& sum) const {
    std::vector<float> fixed;
    for (size_t k = 0; k < states_.size(); ++k) {
      std::vector<float> strengths =
          glare_strengths(light_of(states_[k]), sensor, states_[k].hits[sensor]);
      for (size_t h = 0; is_of_group(k) && h < strengths.size(); ++h) strengths[h] -= fixed[h];
      sum.add_glare(k, strengths);
      if (k == 0) fixed = std::move(strengths);
    }
  }
  // Computes all states of a sensor, and sets its figures.
  HoursOfSensor hours_of(const StateSums& sums, size_t sensor, ErrorSums& errors) {
    StateSums::Sensor sum = sums.begin();
    visit_rays(sensor, DirectRays::Parts::all,
               [&](const StateFamily& family, const DirectRays& rays,
                   std::span<const float> fixed) { add_hours(family, rays, fixed, sensor, sum); });
    if (sensor >= request_.points.size() - request_.eyes) add_glare(sensor, sum);
    const HoursOfSensor means = sum.means(errors);
    const std::vector<float> open = sum.mean_open();
    const auto figures = [&](const HoursOfFigures& hours) {
      return figures_of(hours, result_.times, request_.year.steps_per_hour, options_.figures);
    };
    result_.figures.at(sensor, 0) = figures({means.total, open, means.sun});
    for (size_t r = 0; r < size_t(replicate_count); ++r)
      result_.figures.at(sensor, r + 1) = figures(sum.of_replicate(r));
    return means;
  }

  const AnnualRequest& request_;
  const AnnualOptions& options_;
  const ProgressCallback& progress_;
  const StopFlag& stop_;
  AnnualResult& result_;
  YearOutside outside_;
  LitStates states_;
  std::vector<StateFamily> families_;
};

AnnualResult unfilled_result(const AnnualRequest& request, const AnnualOptions& options) {
  YearSkies skies = make_year_skies(request.year, options.subdivision, options.ground_reflectance,
                                    options.threads);
  YearTimes times = make_year_times(request.year, skies, options.occupancy);
  const size_t hours = skies.hours();
  return {std::move(skies), std::move(times), StateSchedule(request.paths.size(), hours),
          FigureTable(request.points.size(), size_t(replicate_count))};
}

}  // namespace

bool has_several_states(const std::vector<LightPath>& paths) {
  return std::any_of(paths.begin(), paths.end(),
                     [](const LightPath& p) { return p.states.size() > 1; });
}

AnnualResult compute_annual(const AnnualRequest& request, const AnnualOptions& options,
                            const TakeHours& take, const ProgressCallback& progress,
                            const StopFlag& stop) {
  AnnualResult result = unfilled_result(request, options);
  AnnualCalculation calculation(request, options, progress, stop, result);
  // A table of states is read before any long work, so that mistakes show at once.
  const bool has_table = options.blinds != "lm-83";
  result.is_complete = (!has_table || calculation.operate_blinds()) && calculation.reflect() &&
                       (has_table || calculation.operate_blinds()) && calculation.take_hours(take);
  return result;
}

bool compute_reflected_share(const AnnualRequest& request, const AnnualOptions& options,
                             const ProgressCallback& progress, const StopFlag& stop) {
  AnnualResult unused = unfilled_result(request, options);
  return AnnualCalculation(request, options, progress, stop, unused).reflect_share();
}

PictureKey key_of_store(const std::string& program, const AnnualRequest& request,
                        const AnnualOptions& options) {
  return reflected_key(program, request.paths, request.points, request.year, request.compass,
                       reflected_options(options, request.points.size()));
}

}  // namespace troffer
