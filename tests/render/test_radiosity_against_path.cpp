// Irradiance at the sample points of a radiosity solution against path tracing.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/random.h"
#include "import/import.h"
#include "render/measure.h"
#include "render/radiosity.h"

using namespace troffer;

namespace {

// Chooses sample points with probability proportional to area.
std::vector<uint32_t> choose_points(const RadiositySolution& s, int count) {
  std::vector<double> sums;
  double sum = 0;
  for (const ElementPoint& p : s.mesh.points) sums.push_back(sum += double(p.area));
  std::vector<uint32_t> chosen;
  for (int i = 0; i < count; ++i) {
    const double x = sum * (i + 0.5) / count;
    chosen.push_back(uint32_t(std::lower_bound(sums.begin(), sums.end(), x) - sums.begin()));
  }
  return chosen;
}

Rgb direct_irradiance(const RadiositySolution& s, uint32_t point) {
  Rgb sum = s.general_direct[point];
  for (const StoredContribution& c : s.contributions(point))
    if (c.source != no_source && s.is_light(c.source)) sum += c.received;
  return sum;
}

struct Compared {
  double mean = 0;    // ratio of sums minus 1
  double rms = 0;     // relative to the mean
  double median = 0;  // relative
};

template <class Value>
Compared compare(const std::vector<uint32_t>& points, const std::vector<Measurement>& path,
                 const Value& value) {
  double sum = 0, wanted = 0, squares = 0;
  std::vector<double> relative;
  for (size_t i = 0; i < points.size(); ++i) {
    const double a = double(luminance(value(points[i])));
    const double b = double(luminance(path[i].irradiance));
    sum += a;
    wanted += b;
    squares += sqr(a - b);
    if (b > 0) relative.push_back(std::abs(a / b - 1));
  }
  std::sort(relative.begin(), relative.end());
  const auto n = double(points.size());
  return {sum / wanted - 1, std::sqrt(squares / n) / (wanted / n), relative[relative.size() / 2]};
}

}  // namespace

TEST_CASE("kj92room: direct and total irradiance agree with the path tracer") {
  const std::string path = std::string(TROFFER_SOURCE_DIR) + "/scenes/kj92room/kj92room.gltf";
  const PreparedScene scene(import_scene(path));
  const StopFlag never = false;
  RadiosityOptions options;
  options.meshing.element_size = 0.3f;  // coarser than the default to save time
  const RadiositySolution s = preprocess(scene, options, 2, {}, never).solution;
  REQUIRE(s.is_complete);
  const std::vector<uint32_t> chosen = choose_points(s, 200);
  std::vector<MeasuringPoint> points;
  for (const uint32_t i : chosen)
    points.push_back({Vec3d(s.mesh.points[i].position), s.mesh.points[i].normal});
  MeasureOptions o;
  o.method = Method::path;
  o.threads = 2;
  o.spp = 1024;
  const MeasureResult all = measure(scene, points, o, {}, never);
  o.depth = 1;
  const MeasureResult direct = measure(scene, points, o, {}, never);

  const Compared d =
      compare(chosen, direct.values, [&](uint32_t i) { return direct_irradiance(s, i); });
  MESSAGE("direct: mean " << d.mean << ", rms " << d.rms << ", median " << d.median);
  CHECK(std::abs(d.mean) < 0.003);
  CHECK(d.rms < 0.02);
  CHECK(d.median < 0.01);
  const Compared a = compare(chosen, all.values, [&](uint32_t i) {
    const Rgb e = s.irradiance(i);
    return e.is_black() ? e : e + s.ambient;
  });
  MESSAGE("all: mean " << a.mean << ", rms " << a.rms << ", median " << a.median);
  CHECK(std::abs(a.mean) < 0.01);
  CHECK(a.rms < 0.03);
  CHECK(a.median < 0.02);
}
