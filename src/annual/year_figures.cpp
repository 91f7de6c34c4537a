#include "annual/year_figures.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "base/units.h"
#include "render/sample_sets.h"

namespace troffer {

namespace {

constexpr double udi_low = 100, udi_useful = 300, udi_high = 3000;  // [2]
constexpr double sun_lx = 1000;                                     // [1]
constexpr double sda_share = 50, ase_hours = 250;                   // [1]
constexpr double of_time = 50;                                      // [3]: half of daylight hours
constexpr double option_2_least = 300, option_2_most = 3000;        // [4]
constexpr double errors_of_verdict = 2;

double& at(SensorFigures& f, SensorFigure which) {
  return f[size_t(which)];
}
double at(const SensorFigures& f, SensorFigure which) {
  return f[size_t(which)];
}

double mean_of(std::span<const float> total, const std::vector<uint32_t>& hours) {
  double sum = 0;
  for (const uint32_t h : hours) sum += double(total[h]);
  return hours.empty() ? 0 : sum / double(hours.size());
}

// Share of sensors in per cent that `passes` accepts, with its error.
class GridCounter {
 public:
  GridCounter(const FigureTable& table, size_t first, size_t count)
      : table_(table), first_(first), count_(count) {}
  template <class Value>
  YearFigure mean(const Value& value) const {
    std::vector<double> sets(table_.sets(), 0);
    for (size_t set = 0; set < sets.size(); ++set) {
      for (size_t s = first_; s < first_ + count_; ++s) sets[set] += value(table_.at(s, set));
      sets[set] /= double(count_);
    }
    return with_spread(sets[0], std::span(sets).subspan(1));
  }
  template <class Passes>
  YearFigure share(const Passes& passes) const {
    return mean([&](const SensorFigures& f) { return passes(f) ? 100.0 : 0.0; });
  }
  YearFigure mean_of_figure(SensorFigure which) const {
    return mean([&](const SensorFigures& f) { return at(f, which); });
  }
  YearFigure share_from(SensorFigure which, double least) const {
    return share([&](const SensorFigures& f) { return at(f, which) >= least; });
  }

 private:
  const FigureTable& table_;
  size_t first_, count_;
};

void add_least(YearScheme scheme, int level, const std::string& title, const YearFigure& f,
               double least, GridResult& out) {
  out.requirements.push_back({scheme, level, title,
                              fmt::format("at least {:g} % of the plane", least), f,
                              year_verdict(f, least, true)});
}

void add_en_17037(const GridCounter& grid, GridResult& out) {
  struct Level {
    int number;
    const char* name;
    SensorFigure target, minimum;
    int target_lx, minimum_lx;
  };
  // [3], table A.1
  for (const Level& l :
       {Level{1, "minimum", SensorFigure::daylight_300, SensorFigure::daylight_100, 300, 100},
        Level{2, "medium", SensorFigure::daylight_500, SensorFigure::daylight_300, 500, 300},
        Level{3, "high", SensorFigure::daylight_750, SensorFigure::daylight_500, 750, 500}}) {
    add_least(YearScheme::en_17037, l.number,
              fmt::format("EN 17037 {}: {} lx in half of the daylight hours", l.name, l.target_lx),
              grid.share_from(l.target, of_time), 50, out);
    add_least(YearScheme::en_17037, l.number,
              fmt::format("EN 17037 {}: {} lx in half of the daylight hours", l.name, l.minimum_lx),
              grid.share_from(l.minimum, of_time), 95, out);
  }
}

void add_leed(const YearFigure& sda, const YearFigure& ase, const YearFigure& option_2,
              bool has_equinoxes, GridResult& out) {
  for (const auto& [least, points] : {std::pair{40, 1}, {55, 2}, {75, 3}})
    add_least(YearScheme::leed_option_1, points,
              fmt::format("LEED v4.1 option 1, {} point{}: sDA", points, points > 1 ? "s" : ""),
              sda, least, out);
  out.requirements.push_back({YearScheme::leed_ase, 1, "LEED v4.1 option 1: ASE",
                              "at most 10 % of the plane, or a remedy", ase,
                              year_verdict(ase, 10, false)});
  if (!has_equinoxes) return;
  for (const auto& [least, points] : {std::pair{55, 1}, {75, 2}, {90, 3}})
    add_least(YearScheme::leed_option_2, points,
              fmt::format("LEED v4.1 option 2, {} point{}: 300 to 3000 lx at 9 and 15 h", points,
                          points > 1 ? "s" : ""),
              option_2, least, out);
}

}  // namespace

SensorFigures figures_of(const HoursOfFigures& hours, const YearTimes& times, int steps_per_hour,
                         const FigureSettings& settings) {
  SensorFigures f{};
  size_t lit = 0;  // occupied hours with daylight
  std::array<size_t, 4> daylight{};
  double all = 0;
  for (size_t h = 0; h < hours.total.size(); ++h) {
    const double lx = double(hours.total[h]), open_lx = double(hours.open[h]);
    all += lx;
    if (times.is_daylight[h] != 0)
      for (size_t k = 0; k < daylight.size(); ++k)
        daylight[k] += open_lx >= std::array{100, 300, 500, 750}[k];
    if (times.is_occupied[h] == 0) continue;
    ++lit;
    at(f, SensorFigure::da) += lx >= settings.da_lx;
    at(f, SensorFigure::da_open) += open_lx >= settings.da_lx;
    at(f, SensorFigure::cda) += std::min(1.0, lx / settings.da_lx);
    at(f, lx < udi_low      ? SensorFigure::udi_fell_short
          : lx < udi_useful ? SensorFigure::udi_supplementary
          : lx <= udi_high  ? SensorFigure::udi_autonomous
                            : SensorFigure::udi_exceeded) += 1;
    at(f, SensorFigure::mean_lx) += lx;
    at(f, SensorFigure::sun_hours) += double(hours.sun[h]) > sun_lx;
  }
  at(f, SensorFigure::udi_fell_short) += double(times.occupied - lit);
  const auto occupied = double(times.occupied);
  for (size_t k = 0; k <= size_t(SensorFigure::udi_exceeded); ++k) f[k] *= 100 / occupied;
  at(f, SensorFigure::mean_lx) /= occupied;
  at(f, SensorFigure::sun_hours) /= steps_per_hour;
  at(f, SensorFigure::exposure_klxh) = all / steps_per_hour / 1000;
  for (size_t k = 0; k < daylight.size(); ++k)
    f[size_t(SensorFigure::daylight_100) + k] =
        100 * double(daylight[k]) / double(std::max<size_t>(times.daylight, 1));
  at(f, SensorFigure::morning_lx) = mean_of(hours.open, times.mornings);
  at(f, SensorFigure::afternoon_lx) = mean_of(hours.open, times.afternoons);
  return f;
}

double error_of_mean(double squares, size_t n) {
  if (n < 2) return 0;
  constexpr double normal_quantile = 1.96;
  return std::sqrt(squares / double((n - 1) * n)) * t_quantile_95(int(n) - 1) / normal_quantile;
}

YearFigure with_spread(double of_all, std::span<const double> of_replicates) {
  double mean = 0, squares = 0;
  const auto n = double(of_replicates.size());
  // Differences from the first value, so that equal values have no error by rounding.
  for (const double v : of_replicates) mean += (v - of_replicates[0]) / n;
  for (const double v : of_replicates) squares += sqr(v - of_replicates[0] - mean);
  return {of_all, error_of_mean(squares, of_replicates.size())};
}

YearVerdict year_verdict(const YearFigure& f, double limit, bool is_least) {
  if (std::abs(f.value - limit) < errors_of_verdict * f.error) return YearVerdict::undecided;
  return (is_least ? f.value >= limit : f.value <= limit) ? YearVerdict::met : YearVerdict::not_met;
}

ReachedLevel level_reached(const GridResult& result, YearScheme scheme) {
  std::map<int, YearVerdict> worst;  // by level
  for (const GridRequirement& q : result.requirements) {
    if (q.scheme != scheme) continue;
    YearVerdict& v = worst.try_emplace(q.level, YearVerdict::met).first->second;
    if (q.verdict == YearVerdict::not_met || v == YearVerdict::met) v = q.verdict;
  }
  ReachedLevel reached;
  for (const auto& [level, v] : worst) {
    if (v == YearVerdict::met) reached.sure = level;
    if (v != YearVerdict::not_met) reached.possible = level;
  }
  return reached;
}

YearFigure joint_figure(std::span<const YearFigure> figures, std::span<const size_t> sensors) {
  YearFigure sum;
  double all = 0;
  for (size_t i = 0; i < figures.size(); ++i) {
    sum.value += figures[i].value * double(sensors[i]);
    sum.error += figures[i].error * double(sensors[i]);
    all += double(sensors[i]);
  }
  return all > 0 ? YearFigure{sum.value / all, sum.error / all} : sum;
}

YearFigure FigureTable::of(size_t sensor, SensorFigure figure) const {
  std::vector<double> sets;
  for (size_t set = 1; set < sets_; ++set) sets.push_back(troffer::at(at(sensor, set), figure));
  return with_spread(troffer::at(at(sensor, 0), figure), sets);
}

GridResult grid_result(const FigureTable& table, size_t first, size_t count, bool has_equinoxes,
                       bool has_blinds) {
  const GridCounter grid(table, first, count);
  GridResult out;
  const auto add = [&](const char* key, const char* title, const char* unit, const YearFigure& f) {
    out.figures.push_back({key, title, unit, f});
  };
  const YearFigure sda = grid.share_from(SensorFigure::da, sda_share);
  const YearFigure ase = grid.share_from(SensorFigure::sun_hours, ase_hours);
  add("sda", "Spatial daylight autonomy (sDA)", "%", sda);
  if (has_blinds)
    add("sda_open", "sDA with blinds open", "%", grid.share_from(SensorFigure::da_open, sda_share));
  add("ase", "Annual sunlight exposure (ASE 1000/250)", "%", ase);
  struct Row {
    const char *key, *title, *unit;
    SensorFigure figure;
  };
  for (const Row& r :
       {Row{"da", "Daylight autonomy, mean", "%", SensorFigure::da},
        Row{"cda", "Continuous daylight autonomy, mean", "%", SensorFigure::cda},
        Row{"udi_fell_short", "UDI below 100 lx", "%", SensorFigure::udi_fell_short},
        Row{"udi_supplementary", "UDI 100 to 300 lx", "%", SensorFigure::udi_supplementary},
        Row{"udi_autonomous", "UDI 300 to 3000 lx", "%", SensorFigure::udi_autonomous},
        Row{"udi_exceeded", "UDI above 3000 lx", "%", SensorFigure::udi_exceeded},
        Row{"mean_lx", "Mean illuminance in occupied hours", "lx", SensorFigure::mean_lx},
        Row{"exposure_klxh", "Annual light exposure, mean", "klx h", SensorFigure::exposure_klxh},
        Row{"sun_hours", "Occupied hours above 1000 lx of sun, mean", "h",
            SensorFigure::sun_hours}})
    add(r.key, r.title, r.unit, grid.mean_of_figure(r.figure));
  const YearFigure option_2 = grid.share([](const SensorFigures& f) {
    const auto is_within = [&](SensorFigure which) {
      return at(f, which) >= option_2_least && at(f, which) <= option_2_most;
    };
    return is_within(SensorFigure::morning_lx) && is_within(SensorFigure::afternoon_lx);
  });
  if (has_equinoxes)
    add("leed_option_2", "300 to 3000 lx at 9 and 15 h, clear equinox", "%", option_2);
  add_leed(sda, ase, option_2, has_equinoxes, out);
  add_en_17037(grid, out);
  return out;
}

}  // namespace troffer
