#include "annual/sensor_states.h"

#include <cmath>

#include "annual/eye_glare.h"

namespace troffer {

namespace {

constexpr size_t set_count = size_t(replicate_count);

std::vector<CellHit> hits_of(const PreparedScene& scene,
                             const std::vector<MeasuringPoint>& points) {
  std::vector<CellHit> hits;
  for (const MeasuringPlace& p : measuring_places(scene, points))
    hits.push_back({p.position, p.normal, p.normal, p.offset});
  return hits;
}

std::vector<float> mean_of(std::span<const float> values) {
  const size_t hours = values.size() / set_count;
  std::vector<float> out(hours);
  for (size_t h = 0; h < hours; ++h) {
    double sum = 0;
    for (size_t r = 0; r < set_count; ++r) sum += double(values[r * hours + h]);
    out[h] = float(sum / double(set_count));
  }
  return out;
}

}  // namespace

LitStates::LitStates(const std::vector<LightPath>& paths, const std::vector<MeasuringPoint>& points)
    : first_(first_states(paths)) {
  for (const LightPath& p : paths)
    for (const PathState& s : p.states) states_.push_back({s.scene, hits_of(*s.scene, points), {}});
}

std::vector<StateFamily> LitStates::families() const {
  std::vector<SceneOfState> scenes;
  for (size_t p = 0; p < paths(); ++p)
    for (size_t k = first_of(p); k < first_of(p + 1); ++k)
      scenes.push_back({states_[k].scene, states_[k].hits, p});
  return state_families(scenes);
}

StateSums::StateSums(const LitStates& states, const StateSchedule& schedule) : schedule_(schedule) {
  for (size_t p = 0; p < states.paths(); ++p)
    for (size_t k = states.first_of(p); k < states.first_of(p + 1); ++k) {
      path_of_.push_back(p);
      number_of_.push_back(k - states.first_of(p));
    }
}

StateSums::Sensor::Sensor(const StateSums& owner) : owner_(owner) {
  const size_t n = set_count * owner.schedule_.hours;
  for (std::vector<float>* v : {&operated_, &open_, &sun_}) v->assign(n, 0);
  states_.resize(owner.path_of_.size());
  for (HoursOfState& s : states_)
    for (std::vector<float>* v : {&s.total, &s.sun}) v->resize(owner.schedule_.hours);
}

void StateSums::Sensor::add(size_t k, const RunOfHours& run) {
  const std::span<const uint16_t> shown = owner_.schedule_.of(owner_.path_of_[k]);
  const size_t number = owner_.number_of_[k], hours = owner_.schedule_.hours;
  for (size_t r = 0; r < set_count; ++r) {
    const size_t first = r * hours + run.first;
    for (size_t i = 0; i < run.count; ++i)
      operated_[first + i] += shown[run.first + i] == number ? run.total[r][i] : 0;
    if (number > 0) continue;
    for (size_t i = 0; i < run.count; ++i) open_[first + i] += run.total[r][i];
    for (size_t i = 0; i < run.count; ++i) sun_[first + i] += run.sun[r][i];
  }
  for (size_t i = 0; i < run.count; ++i) {
    double total = 0, sun = 0;
    for (size_t r = 0; r < set_count; ++r) {
      total += double(run.total[r][i]);
      sun += double(run.sun[r][i]);
    }
    states_[k].total[run.first + i] = float(total / double(set_count));
    states_[k].sun[run.first + i] = float(sun / double(set_count));
  }
}

void StateSums::Sensor::add_glare(size_t k, const std::vector<float>& strengths) {
  strengths_.resize(strengths.size(), 0);
  const std::span<const uint16_t> shown = owner_.schedule_.of(owner_.path_of_[k]);
  for (size_t h = 0; h < strengths.size(); ++h)
    if (shown[h] == owner_.number_of_[k]) strengths_[h] += strengths[h];
}

HoursOfSensor StateSums::Sensor::means(ErrorSums& sums) {
  HoursOfSensor out{mean_of(operated_), {}, mean_of(sun_), std::move(states_), {}};
  for (size_t h = 0; h < strengths_.size(); ++h)
    out.dgp.push_back(float(hourly_dgp(double(out.total[h]), double(strengths_[h]))));
  const size_t hours = out.total.size();
  out.error.assign(hours, 0);
  for (size_t h = 0; h < hours; ++h) {
    double squares = 0;
    const double mean = double(out.total[h]);
    for (size_t r = 0; r < set_count; ++r) {
      const double d = double(operated_[r * hours + h]) - mean;
      squares += d * d;
    }
    const double error = error_of_mean(squares, set_count);
    out.error[h] = float(error);
    sums.squares += mean * mean;
    sums.errors += error * error;
  }
  return out;
}

std::vector<float> StateSums::Sensor::mean_open() const {
  return mean_of(open_);
}

HoursOfFigures StateSums::Sensor::of_replicate(size_t replicate) const {
  const size_t hours = owner_.schedule_.hours, first = replicate * hours;
  return {std::span(operated_).subspan(first, hours), std::span(open_).subspan(first, hours),
          std::span(sun_).subspan(first, hours)};
}

}  // namespace troffer
