// Tests that cells follow the light: sources that are huge or almost touch the receivers, so that
// little of them gives most light, or whose light is mostly hidden.
#include <doctest/doctest.h>

#include <cmath>

#include "light/irradiance.h"
#include "one_source.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// Returns a level square of `side` metres around (x, y, z).
Quad square(float x, float y, float z, float side) {
  const float h = 0.5f * side;
  return {Vec3{x - h, y - h, z}, {x + h, y - h, z}, {x + h, y + h, z}, {x - h, y + h, z}};
}

FlatSource level_panel(double side, double height, bool is_disk = false) {
  return {{{-side / 2, -side / 2, height}, {side, 0, 0}, {0, side, 0}, {0, 0, -1}}, {}, is_disk};
}

double light_behind(const Quad& q, const ShadowReceiver& r) {
  std::vector<Vec3d> corners;
  for (const Vec3& v : q) corners.push_back(Vec3d(v));
  return polygon_irradiance(corners, Vec3d(r.position), Vec3d(r.normal), Sides::both);
}

struct Made {
  double bias = 0, rms = 0, told = 0;  // relative to the visible light
};

// Measures errors over seeds. Facets between source and receivers must not overlap as seen from
// there, so that the visible light is known exactly.
Made made_over_seeds(const FlatSource& source, const std::vector<Quad>& facets, int seeds) {
  BruteForceScene scene;
  scene.facets = facets;
  std::vector<ShadowReceiver> receivers = receivers_on_floor(2, 0.01f);
  CertifiedOptions options;
  options.lattice = fine_lattice;
  Made made;
  const double n = double(seeds) * double(receivers.size());
  for (int seed = 0; seed < seeds; ++seed) {
    for (size_t i = 0; i < receivers.size(); ++i) receivers[i].stream = hash_of(uint64_t(seed), i);
    std::vector<SourceVisibility> out(receivers.size());
    FoundFacets found;
    evaluate_alone(options, source, receivers, scene, found, out);
    for (size_t i = 0; i < receivers.size(); ++i) {
      double left = double(out[i].unoccluded);
      for (const Quad& q : facets) left -= light_behind(q, receivers[i]);
      const double scale = double(out[i].unoccluded) / left;
      const double error = double(out[i].visible) * scale - 1;
      made.bias += error / n;
      made.rms += error * error / n;
      made.told += double(out[i].variance) * scale * scale / n;
    }
  }
  made.rms = std::sqrt(made.rms);
  made.told = std::sqrt(made.told);
  MESSAGE("bias ", made.bias, ", rms ", made.rms, ", told ", made.told);
  return made;
}

}  // namespace

TEST_CASE("source cells: sky panels of 500 m and 2 km, seen past a table") {
  for (const double side : {500.0, 2000.0}) {
    for (const float table : {2.0f, 16.0f, 40.0f}) {  // 40 m leaves a fiftieth of the light
      CAPTURE(side);
      CAPTURE(table);
      const Made made = made_over_seeds(level_panel(side, 10), {square(0.3f, 0.2f, 3, table)}, 30);
      CHECK(std::abs(made.bias) < 0.002);
      CHECK(made.rms < 0.02);
      CHECK(made.rms < 2 * made.told);
    }
  }
}

TEST_CASE("source cells: receivers close to a disk") {
  const Made made =
      made_over_seeds(level_panel(4, 0.25, true),
                      {square(0.05f, 0.02f, 0.1f, 0.2f), square(0.9f, 0, 0.2f, 0.4f)}, 60);
  CHECK(std::abs(made.bias) < 0.001);
  CHECK(made.rms < 0.004);
}

TEST_CASE("source cells: quarters of a disk cover it, and light varies little over each") {
  const FlatSource source = level_panel(4, 0.3, true);
  OneSource one(receivers_on_floor(4, 0.01f), source);
  std::vector<FlatCell> cells;
  cut_cells(visible_part(source, one.cluster.hull), one.cluster.hull, CellLimits(), cells);
  CHECK(cells.size() > 8);
  std::vector<double> sum(16, 0);
  std::vector<float> light;
  for (const FlatCell& c : cells) {
    unoccluded_light(one.cluster, source, c.all_corners(), light);
    for (size_t i = 0; i < 16; ++i) sum[i] += double(light[i]);
  }
  for (size_t i = 0; i < 16; ++i)
    CHECK(sum[i] == doctest::Approx(double(one.unoccluded[i])).epsilon(1e-4));
}

TEST_CASE("a facet whose edges cross the source's plane four times by rounding is kept whole") {
  const FlatSource source = ceiling_source();
  const MaskFrame frame(source.plane, coarse_lattice, false, {0, 0, 0});
  FacetList list;
  list.add(frame, {Vec3{0, 0, 1.999f}, {0.2f, 0, 2.001f}, {0.2f, 0.2f, 1.999f}, {0, 0.2f, 2.001f}});
  CHECK(list.quads().size() * 16 >= 2);
  CHECK(list.size() == 2);  // six corners: two quadrilaterals
}
