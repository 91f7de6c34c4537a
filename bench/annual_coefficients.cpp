// Daylight coefficients of sensors, direct and reflected light together, for Tregenza's 145 patches
// and the ground. bench/annual-speed runs it.
//
//   bench_annual_coefficients SCENE POINTS OUTPUT RAYS SEED THREADS
//
// POINTS: text with lines x y z nx ny nz. z is up, y is north. RAYS: gather rays of a sensor in all
// replicates together. OUTPUT: floats, sensor by sensor: for the ground and each patch the
// illuminance in lx per cd/m², then the same number of their standard errors.
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <stdexcept>

#include "annual/sensor_hours.h"
#include "annual/sensor_states.h"
#include "base/parallel.h"
#include "import/import.h"

using namespace troffer;

namespace {

const StopFlag never = false;

struct CoefficientsRequest {
  std::string scene, points, output;
  int rays = 0, threads = 0;
  uint64_t seed = 0;
};

std::vector<MeasuringPoint> read_points(const std::string& path) {
  std::vector<MeasuringPoint> points;
  std::ifstream in(path);
  MeasuringPoint p;
  while (in >> p.position.x >> p.position.y >> p.position.z >> p.normal.x >> p.normal.y >>
         p.normal.z)
    points.push_back(p);
  return points;
}

// Skies with one source each: hour 0 has the ground, hour 1 + p has patch p.
YearSkies single_sources() {
  const ReinhartSky sky(1);
  const size_t n = sky.size() + 1;
  PatchHours patches{sky, std::vector<float>(sky.size() * n, 0)};
  for (size_t p = 0; p < sky.size(); ++p) patches.luminance[p * n + p + 1] = 1;
  YearSkies skies{std::vector<uint32_t>(n, 0),
                  patches,
                  patches,
                  std::vector<float>(n, 0),
                  std::vector<float>(n, 0),
                  std::vector<float>(n, 0)};
  skies.ground[0] = 1;
  return skies;
}

// Sets `out` to the means over replicates, then to the errors of these means.
void add_statistics(const RunOfHours& run, float* out) {
  for (size_t h = 0; h < run.count; ++h) {
    double mean = 0, squares = 0;
    for (const auto& of_replicate : run.total) mean += double(of_replicate[h]) / replicate_count;
    for (const auto& of_replicate : run.total)
      squares += std::pow(double(of_replicate[h]) - mean, 2);
    out[h] = float(mean);
    out[run.count + h] = float(std::sqrt(squares / (replicate_count * (replicate_count - 1))));
  }
}

void compute(const CoefficientsRequest& request) {
  const auto scene = std::make_shared<const PreparedScene>(import_scene(request.scene));
  const std::vector<MeasuringPoint> points = read_points(request.points);
  const std::vector<LightPath> paths{{static_path, {{"default", scene}}}};
  const YearSkies skies = single_sources();
  WeatherYear year;
  year.steps.resize(1);
  const Compass compass = make_compass({0, 0, 1}, 0, false);
  const YearOutside outside{year, skies, compass, request.seed};
  LitStates states(paths, points);
  const StateFamily family = states.families().at(0);
  ReflectedOptions options;
  options.rays.of_sensor = (request.rays + replicate_count - 1) / replicate_count;
  options.seed = request.seed;
  options.threads = request.threads;
  options.subdivision = 1;
  states[0].reflected = reflected_light(family, year, compass, options, {}, never).at(0);
  const YearOfLight light{*scene, outside, states[0].reflected};
  const size_t n = skies.hours();
  std::vector<float> values(points.size() * 2 * n);
  parallel_for(points.size(), request.threads, [&](size_t s) {
    const DirectRays rays(outside, family, s, DirectRays::Parts::all);
    const std::vector<float> open = rays.open_in(family.states[0]);
    SensorHours hours(light, s, family.sensors[s], rays, open);
    RunOfHours run;
    run.count = n;
    hours.compute(run);
    add_statistics(run, &values[s * 2 * n]);
  });
  std::ofstream out(request.output, std::ios::binary);
  out.write(reinterpret_cast<const char*>(values.data()),
            std::streamsize(values.size() * sizeof(float)));
  if (!out) throw std::runtime_error("cannot write " + request.output);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 7) {
    fmt::print(stderr, "usage: bench_annual_coefficients SCENE POINTS OUTPUT RAYS SEED THREADS\n");
    return 2;
  }
  try {
    compute(
        {argv[1], argv[2], argv[3], std::stoi(argv[4]), std::stoi(argv[6]), std::stoull(argv[5])});
  } catch (const std::exception& e) {
    fmt::print(stderr, "error: {}\n", e.what());
    return 1;
  }
  return 0;
}
