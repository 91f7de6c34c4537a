// Metrics and operation of blinds from hourly arrays that another program computed.
// bench/annual-honeybee runs it.
//
//   bench_annual_figures FOLDER
//
// FOLDER/layout.txt: hours, occupied hours of the year, sensors, paths; then the number of states
// of each path; then one 0 or 1 per hour: occupied or not. Arrays of floats, sensor by sensor:
// PATH-STATE-total.f32 and PATH-STATE-direct.f32. Optional schedule.txt: one state per path and
// hour, path by path; without it, blinds follow IES LM-83. Writes figures.csv and
// schedule_found.txt.
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <stdexcept>

#include "annual/blinds.h"
#include "annual/year_figures.h"

using namespace troffer;

namespace {

struct Layout {
  size_t hours = 0, occupied = 0, sensors = 0, paths = 0;
  std::vector<size_t> states;
  std::vector<uint8_t> is_occupied;
};

Layout read_layout(const std::string& folder) {
  std::ifstream in(folder + "/layout.txt");
  Layout l;
  in >> l.hours >> l.occupied >> l.sensors >> l.paths;
  l.states.resize(l.paths);
  for (size_t& s : l.states) in >> s;
  for (size_t h = 0; h < l.hours; ++h) {
    int flag = 0;
    in >> flag;
    l.is_occupied.push_back(uint8_t(flag));
  }
  if (!in) throw std::runtime_error("layout.txt is too short");
  return l;
}

std::vector<float> read_array(const std::string& path, size_t count) {
  std::vector<float> v(count);
  std::ifstream in(path, std::ios::binary);
  in.read(reinterpret_cast<char*>(v.data()), std::streamsize(count * sizeof(float)));
  if (!in) throw std::runtime_error(path + " is too short");
  return v;
}

// Rounds to 11 bits, as the published metrics do with the sum over groups: a sum that differs from
// a threshold by less than that counts as equal to it.
float rounded_to_half(float v) {
  int exponent = 0;
  std::frexp(v, &exponent);
  const float unit = std::ldexp(1.0f, exponent - 11);
  return std::nearbyint(v / unit) * unit;
}

SunOfSensors sun_of(const std::vector<float>& direct, const Layout& l) {
  SunOfSensors out(l.sensors);
  for (size_t s = 0; s < l.sensors; ++s)
    for (size_t h = 0; h < l.hours; ++h)
      if (direct[s * l.hours + h] > 0) out[s].push_back({uint32_t(h), direct[s * l.hours + h]});
  return out;
}

void run(const std::string& folder) {
  const Layout l = read_layout(folder);
  const size_t size = l.hours * l.sensors;
  const auto name = [&](size_t p, size_t s, const char* part) {
    return fmt::format("{}/{}-{}-{}.f32", folder, p, s, part);
  };
  std::vector<LightPath> paths;
  std::vector<SunOfPath> sun;
  std::vector<float> direct(size, 0), open(size, 0), total(size, 0);
  for (size_t p = 0; p < l.paths; ++p) {
    paths.push_back({fmt::format("{}", p), std::vector<PathState>(l.states[p])});
    const std::vector<float> of_path = read_array(name(p, 0, "direct"), size);
    sun.push_back(
        {sun_of(of_path, l), sun_of(read_array(name(p, l.states[p] - 1, "direct"), size), l)});
    for (size_t i = 0; i < size; ++i) direct[i] += of_path[i];
  }
  const std::vector<SensorSpan> grids{{0, l.sensors}};
  StateSchedule schedule = lm83_schedule(paths, sun, grids, l.hours);
  std::ofstream found(folder + "/schedule_found.txt");
  for (const uint16_t s : schedule.states) found << s << "\n";
  if (std::ifstream given(folder + "/schedule.txt"); given)
    for (uint16_t& s : schedule.states) given >> s;
  for (size_t p = 0; p < l.paths; ++p)
    for (size_t k = 0; k < l.states[p]; ++k) {
      const std::vector<float> of_state = read_array(name(p, k, "total"), size);
      for (size_t i = 0; i < size; ++i) {
        if (schedule.of(p)[i % l.hours] == k) total[i] += of_state[i];
        if (k == 0) open[i] += of_state[i];
      }
    }
  for (float& v : total) v = rounded_to_half(v);
  YearTimes times;
  times.is_occupied = l.is_occupied;
  times.occupied = l.occupied;
  times.is_daylight.assign(l.hours, 0);
  std::ofstream out(folder + "/figures.csv");
  out << "da,cda,udi_lower,udi_100_300,udi_300_3000,udi_upper,hours_above\n";
  for (size_t s = 0; s < l.sensors; ++s) {
    const auto row = [&](const std::vector<float>& v) {
      return std::span(v).subspan(s * l.hours, l.hours);
    };
    const SensorFigures f = figures_of({row(total), row(open), row(direct)}, times, 1, {300});
    const auto at = [&](SensorFigure which) { return f[size_t(which)]; };
    out << fmt::format("{},{},{},{},{},{},{}\n", at(SensorFigure::da), at(SensorFigure::cda),
                       at(SensorFigure::udi_fell_short), at(SensorFigure::udi_supplementary),
                       at(SensorFigure::udi_autonomous), at(SensorFigure::udi_exceeded),
                       at(SensorFigure::sun_hours));
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: bench_annual_figures FOLDER\n");
    return 2;
  }
  try {
    run(argv[1]);
  } catch (const std::exception& e) {
    fmt::print(stderr, "error: {}\n", e.what());
    return 1;
  }
  return 0;
}
