// Compares radiosity solutions with the path tracer's irradiance. Values are interpolated at places
// that a camera sees and at places all over the surfaces, for several settings. Times are processor
// seconds of the preprocessing on two threads.
//
//   bench_radiosity_accuracy SCENE [--places N] [--spp N] [VARIANT…]
//
// A variant is a list such as element=0.5,patch=2,unshot=0.01,tolerance=0.003,rays=64,light=64;
// "default" is the default. Radiosity lacks light by way of mirrors or glass.

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "base/frame.h"
#include "base/random.h"
#include "import/import.h"
#include "radiosity/interpolation.h"
#include "render/camera.h"
#include "render/measure.h"
#include "render/radiosity.h"

using namespace troffer;

namespace {

constexpr int threads = 2;

// Processor time of all threads, which other programs do not affect.
double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_utime.tv_sec) + double(usage.ru_utime.tv_usec) * 1e-6;
}

struct Place {
  Hit hit;
  Vec3 position, normal;  // normal on the visible side
  bool is_back = false;
};

Place place_of(const PreparedScene& scene, const Ray& ray, const Hit& hit) {
  Place p;
  Surface surface;
  surface_at(scene.scene, ray, hit, surface);
  p.hit = hit;
  p.position = surface.position;
  p.is_back = dot(surface.geometric_normal, ray.direction) > 0;
  p.normal = p.is_back ? -surface.geometric_normal : surface.geometric_normal;
  return p;
}

std::vector<Place> visible_places(const PreparedScene& scene, int count) {
  std::vector<Place> places;
  if (scene.scene.cameras.empty()) return places;
  const ViewingCamera camera(scene.scene.cameras[0], 1000, 750);
  Random random(1);
  for (int i = 0; i < count; ++i) {
    const Ray ray =
        camera.ray({1000 * random.next_float(), 750 * random.next_float()}, {0.5f, 0.5f});
    Hit hit;
    scene.tracer.closest({&ray, 1}, {&hit, 1});
    if (hit.is_valid()) places.push_back(place_of(scene, ray, hit));
  }
  return places;
}

// Returns places spread over the triangles by area, on either side with equal probability.
std::vector<Place> surface_places(const PreparedScene& scene, int count) {
  std::vector<Place> places;
  std::vector<double> sums;
  std::vector<std::array<uint32_t, 2>> triangles;
  double sum = 0;
  for (uint32_t m = 0; m < scene.scene.meshes.size(); ++m) {
    const Mesh& mesh = scene.scene.meshes[m];
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const Triangle& c = mesh.triangles[t];
      const Vec3 a = mesh.positions[c[0]];
      sum += double(length(cross(mesh.positions[c[1]] - a, mesh.positions[c[2]] - a)));
      sums.push_back(sum);
      triangles.push_back({m, t});
    }
  }
  Random random(2);
  for (int i = 0; i < count && sum > 0; ++i) {
    const auto k =
        size_t(std::lower_bound(sums.begin(), sums.end(), sum * double(random.next_float())) -
               sums.begin());
    const auto [m, t] = triangles[std::min(k, triangles.size() - 1)];
    const Mesh& mesh = scene.scene.meshes[m];
    const Triangle& c = mesh.triangles[t];
    const Vec2 w = triangle_from_square(random.next_vec2());
    const Vec3 a = mesh.positions[c[0]], b = mesh.positions[c[1]], d = mesh.positions[c[2]];
    const Vec3 at = a + (b - a) * w.x + (d - a) * w.y;
    const Vec3 n = normalize(cross(b - a, d - a));
    if (!is_finite(n)) continue;
    const bool is_back = random.next_float() < 0.5f;
    Place p;
    p.hit.geometry = m;
    p.hit.primitive = t;
    p.hit.u = w.x;
    p.hit.v = w.y;
    p.position = at;
    p.normal = is_back ? -n : n;
    p.is_back = is_back;
    places.push_back(p);
  }
  return places;
}

// Returns the path tracer's irradiance (luminance). Places without light are removed.
std::vector<double> reference(const PreparedScene& scene, std::vector<Place>& places, int spp,
                              double& noise) {
  std::vector<MeasuringPoint> points;
  for (const Place& p : places) points.push_back({Vec3d(p.position), p.normal});
  MeasureOptions options;
  options.method = Method::path;
  options.spp = spp;
  options.threads = threads;
  const StopFlag never = false;
  const MeasureResult r = measure(scene, points, options, {}, never);
  std::vector<double> values;
  std::vector<Place> kept;
  double squares = 0, sum = 0;
  for (size_t i = 0; i < places.size(); ++i) {
    const double e = double(luminance(r.values[i].irradiance));
    if (!(e > 0)) continue;
    kept.push_back(places[i]);
    values.push_back(e);
    sum += e;
    const double error = r.values[i].standard_error / r.values[i].illuminance_lx * e;
    squares += error * error;
  }
  places = kept;
  const auto n = double(values.size());
  noise = std::sqrt(squares / n) / (sum / n);
  return values;
}

struct Errors {
  double rms = 0, median = 0, mean = 0, p90 = 0;
};

Errors compare(const PreparedScene& scene, const RadiositySolution& s,
               const std::vector<Place>& places, const std::vector<double>& wanted) {
  double squares = 0, sum = 0, sum_wanted = 0;
  std::vector<double> relative;
  Interpolation at;
  for (size_t i = 0; i < places.size(); ++i) {
    const Place& p = places[i];
    interpolate(scene.scene, s.mesh, p.hit.geometry, p.hit.primitive, p.hit.u, p.hit.v, p.position,
                p.is_back, at);
    double e = 0;
    for (const PointWeight& w : at.weights()) {
      const Rgb irradiance = s.irradiance(w.point);
      if (!irradiance.is_black()) e += double(luminance(irradiance + s.ambient) * w.weight);
    }
    squares += (e - wanted[i]) * (e - wanted[i]);
    sum += e;
    sum_wanted += wanted[i];
    relative.push_back(std::abs(e - wanted[i]) / wanted[i]);
  }
  const auto n = double(places.size());
  std::sort(relative.begin(), relative.end());
  Errors r;
  r.rms = std::sqrt(squares / n) / (sum_wanted / n);
  r.mean = sum / sum_wanted - 1;
  r.median = relative[relative.size() / 2];
  r.p90 = relative[relative.size() * 9 / 10];
  return r;
}

RadiosityOptions parse(const std::string& text) {
  RadiosityOptions o;
  if (text == "default") return o;
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find(',', at), text.size());
    const size_t equals = text.find('=', at);
    if (equals >= end) throw std::runtime_error("no variant: " + text);
    const std::string name = text.substr(at, equals - at);
    const double v = std::atof(text.substr(equals + 1, end - equals - 1).c_str());
    if (name == "element")
      o.meshing.element_size = float(v);
    else if (name == "patch")
      o.meshing.patch_size = float(v);
    else if (name == "elements")
      o.meshing.max_elements = uint32_t(v);
    else if (name == "sheets")
      o.meshing.max_sheets = uint32_t(v);
    else if (name == "unshot")
      o.unshot_fraction = float(v);
    else if (name == "tolerance")
      o.tolerance = float(v);
    else if (name == "rays")
      o.max_rays = int(v);
    else if (name == "emitter")
      o.light_rays = int(v);
    else if (name == "share")
      o.light_share = float(v);
    else
      throw std::runtime_error("no variant: " + name);
    at = end + 1;
  }
  return o;
}

void run(const std::string& file, int count, int spp, const std::vector<std::string>& variants) {
  const PreparedScene scene(import_scene(file));
  std::vector<Place> seen = visible_places(scene, count), all = surface_places(scene, count);
  double seen_noise = 0, all_noise = 0;
  const std::vector<double> seen_wanted = reference(scene, seen, spp, seen_noise);
  const std::vector<double> all_wanted = reference(scene, all, spp, all_noise);
  fmt::print("{}\n  {} places seen, noise of the reference {:.2f} %; {} by area, {:.2f} %\n", file,
             seen.size(), 100 * seen_noise, all.size(), 100 * all_noise);
  fmt::print("  {:44} {:>6} {:>6} {:>7} {:>6} {:>5} | {:>30} | {:>30}\n", "", "s", "shots",
             "M rays", "points", "MB", "seen: rms median 90 % mean, %", "by area");
  const StopFlag never = false;
  for (const std::string& variant : variants) {
    const double start = cpu_seconds();
    const RadiosityResult r = preprocess(scene, parse(variant), threads, {}, never);
    const double cpu = cpu_seconds() - start;
    const RadiositySolution& s = r.solution;
    fmt::print("  {:44} {:6.2f} {:6} {:7.1f} {:6} {:5.1f}", variant, cpu, s.shots,
               double(s.rays) * 1e-6, s.mesh.points.size(), double(s.memory_bytes()) * 1e-6);
    for (const bool is_seen : {true, false}) {
      const auto& places = is_seen ? seen : all;
      if (places.empty()) continue;
      const Errors e = compare(scene, s, places, is_seen ? seen_wanted : all_wanted);
      fmt::print(" | {:6.2f} {:6.2f} {:7.2f} {:+7.2f}", 100 * e.rms, 100 * e.median, 100 * e.p90,
                 100 * e.mean);
    }
    fmt::print("\n");
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::string file;
  std::vector<std::string> variants;
  int places = 1000, spp = 2048;
  for (int i = 1; i < argc; ++i) {
    const std::string a = argv[i];
    if (a == "--places" && i + 1 < argc)
      places = std::atoi(argv[++i]);
    else if (a == "--spp" && i + 1 < argc)
      spp = std::atoi(argv[++i]);
    else if (file.empty())
      file = a;
    else
      variants.push_back(a);
  }
  if (file.empty()) file = TROFFER_SOURCE_DIR "/scenes/kj92room/kj92room.gltf";
  if (variants.empty()) variants = {"default"};
  try {
    run(file, places, spp, variants);
  } catch (const std::exception& e) {
    fmt::print(stderr, "error: {}\n", e.what());
    return 1;
  }
  return 0;
}
