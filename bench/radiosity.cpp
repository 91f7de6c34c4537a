// Measures time, memory and accuracy of the radiosity preprocessing at default settings, on two
// threads. The accuracy refers to a solution on the same mesh with a third of the error per
// transfer and a fifth of the unshot power. Both include their ambient estimate.
//
//   bench_radiosity [SCENE…]     (default: scenes/kj92room and scenes/modern-hall of the
//   repository)

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <string>
#include <vector>

#include "import/import.h"
#include "radiosity/solver.h"

using namespace troffer;

namespace {

using Clock = std::chrono::steady_clock;
constexpr int threads = 2;

double seconds_since(Clock::time_point t) {
  return std::chrono::duration<double>(Clock::now() - t).count();
}

void compare(const RadiositySolution& a, const RadiositySolution& b) {
  double mean_a = 0, mean_b = 0, squares = 0, area = 0;
  std::vector<double> relative;
  for (uint32_t i = 0; i < a.mesh.points.size(); ++i) {
    const double w = double(a.mesh.points[i].area);
    const double x = double(luminance(a.irradiance(i) + a.ambient));
    const double y = double(luminance(b.irradiance(i) + b.ambient));
    mean_a += w * x;
    mean_b += w * y;
    squares += w * (x - y) * (x - y);
    area += w;
    relative.push_back(std::abs(x - y) / std::max(y, 1e-12));
  }
  if (relative.empty() || !(mean_b > 0)) return;
  const auto middle = relative.begin() + std::ptrdiff_t(relative.size() / 2);
  std::nth_element(relative.begin(), middle, relative.end());
  fmt::print(
      "  against a finer solution: rms {:.2f} % of the mean, median {:.2f} %, mean {:+.2f} %\n",
      100 * std::sqrt(squares / area) / (mean_b / area), 100 * *middle,
      100 * (mean_a / mean_b - 1));
}

void run(const std::string& file) {
  const Scene scene = import_scene(file);
  const Tracer tracer(scene);
  const BsdfTables tables(scene);
  const LightPrimitives lights(scene);
  const RadiosityOptions options;
  const StopFlag never = false;
  Clock::time_point start = Clock::now();
  const RadiosityMesh mesh = mesh_for_radiosity(scene, tracer, tables, options.meshing, threads);
  const double meshing = seconds_since(start);
  start = Clock::now();
  double previous = 0;
  const RadiositySolution s = solve_radiosity(
      scene, tracer, tables, lights, options, threads,
      [&](const RadiosityProgress& p) {
        const double now = seconds_since(start);
        if (now < previous + 5) return;
        previous = now;
        fmt::print(stderr, "  {:5.0f} s: {} shots, {:.2f} % unshot\n", now, p.shots,
                   100 * p.unshot);
      },
      never);
  const double all = seconds_since(start);
  double received = 0, area = 0;
  for (uint32_t i = 0; i < s.mesh.points.size(); ++i) {
    received += double(luminance(s.irradiance(i)) * s.mesh.points[i].area);
    area += double(s.mesh.points[i].area);
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const EnergyBalance& b = s.balance;
  fmt::print("{}\n", file);
  fmt::print("  triangles {}, fragments {}, elements {}, sample points {}, patches {}\n",
             triangle_count(scene), s.mesh.fragments.size(), s.mesh.element_count,
             s.mesh.points.size(), s.mesh.patches.size());
  fmt::print("  element size {:.3f} m, patch size {:.3f} m, joined up to {:.0f} degrees\n",
             s.mesh.element_size, s.mesh.patch_size, s.mesh.join_angle_deg);
  fmt::print("  meshing {:.2f} s, all {:.2f} s; {} shots, {:.1f} M rays\n", meshing, all, s.shots,
             double(s.rays) * 1e-6);
  fmt::print("  solution {:.1f} MB, whole process at most {:.0f} MB\n",
             double(s.memory_bytes()) * 1e-6, double(usage.ru_maxrss) * 1.024e-3);
  fmt::print(
      "  of what is emitted: absorbed {:.3f}, to specular {:.3f}, unshot {:.3f}, "
      "escaped or error {:.4f}\n",
      b.absorbed / b.emitted, b.lost_to_specular / b.emitted, b.unshot / b.emitted,
      b.escaped / b.emitted);
  RadiosityOptions finer = options;
  finer.max_rays *= 4;
  finer.tolerance /= 3;
  finer.unshot_fraction /= 5;
  finer.seed = 9;
  compare(s, solve_radiosity(scene, tracer, tables, lights, finer, threads, {}, never));
  fmt::print("  mean irradiance {:.5g} on {:.1f} m2\n", received / area, area);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> files(argv + 1, argv + argc);
  if (files.empty())
    files = {TROFFER_SOURCE_DIR "/scenes/kj92room/kj92room.gltf",
             TROFFER_SOURCE_DIR "/scenes/modern-hall/modern-hall.pbrt"};
  try {
    for (const std::string& f : files) run(f);
  } catch (const std::exception& e) {
    fmt::print(stderr, "error: {}\n", e.what());
    return 1;
  }
  return 0;
}
