// Tests that masks meet the asked error: cells are refined where a source's light comes from.
#include <doctest/doctest.h>

#include <cmath>

#include "light/irradiance.h"
#include "one_source.h"
#include "shadow/cell_facets.h"
#include "shadow/cell_points.h"
#include "shadow/plan_cells.h"

using namespace troffer;
using namespace troffer::test;

namespace test_plan_cells {

namespace {

// Returns a level plane at height z with a square hole around (x, y).
std::vector<Quad> plane_with_hole(float x, float y, float side, float z) {
  const float far = 20, h = side / 2;
  const auto plate = [&](float x0, float x1, float y0, float y1) {
    return Quad{Vec3{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
  };
  return {plate(-far, x - h, -far, far), plate(x + h, far, -far, far),
          plate(x - h, x + h, -far, y - h), plate(x - h, x + h, y + h, far)};
}

struct Made {
  double bias = 0, rms = 0, told = 0;  // relative to the light that arrives
  double light = 0;                    // mean, sr
  uint64_t masks = 0;
};

Made made_through_hole(float side, float error, int seeds, float floor = 0) {
  const FlatSource source = ceiling_source();
  BruteForceScene scene;
  scene.facets = plane_with_hole(0.05f, -0.03f, side, 1);
  std::vector<ShadowReceiver> receivers = receivers_on_floor(3, 0.01f);
  CertifiedOptions options;
  options.lattice = fine_lattice;
  options.mask_error = error;
  Made made;
  const double n = double(seeds) * double(receivers.size());
  for (int seed = 0; seed < seeds; ++seed) {
    for (size_t i = 0; i < receivers.size(); ++i) {
      receivers[i].stream = hash_of(uint64_t(seed), i);
      receivers[i].floor = floor;
    }
    std::vector<SourceVisibility> out(receivers.size());
    FoundFacets found;
    made.masks += evaluate_alone(options, source, receivers, scene, found, out).masks;
    for (size_t i = 0; i < receivers.size(); ++i) {
      const float x = 0.05f, y = -0.03f, h = side / 2;
      const std::vector<Vec3d> hole{{double(x - h), double(y - h), 1},
                                    {double(x + h), double(y - h), 1},
                                    {double(x + h), double(y + h), 1},
                                    {double(x - h), double(y + h), 1}};
      const double light =
          polygon_irradiance(hole, Vec3d(receivers[i].position), {0, 0, 1}, Sides::both);
      const double error_made = double(out[i].visible) * double(out[i].unoccluded) / light - 1;
      made.light += light / n;
      made.bias += error_made / n;
      made.rms += sqr(error_made) / n;
      made.told += double(out[i].variance) * sqr(double(out[i].unoccluded) / light) / n;
    }
  }
  made.rms = std::sqrt(made.rms);
  made.told = std::sqrt(made.told);
  MESSAGE("hole of ", side, " m, asked ", error, ": bias ", made.bias, ", rms ", made.rms,
          ", told ", made.told);
  return made;
}

}  // namespace

TEST_CASE("masks keep the asked error of the light that arrives through a hole") {
  for (const float side : {0.02f, 0.1f, 0.3f})
    for (const float error : {0.03f, 0.01f, 0.003f}) {
      CAPTURE(side);
      CAPTURE(error);
      const Made made = made_through_hole(side, error, 40);
      CHECK(made.rms < 1.2 * double(error));
      CHECK(std::abs(made.bias) < 0.2 * double(error));
      CHECK(made.told < 2.5 * double(error));
    }
}

TEST_CASE("masks: light far below the floor may have a larger error and costs less") {
  const Made strict = made_through_hole(0.1f, 0.003f, 40);
  const float floor = 20 * float(strict.light);
  const Made loose = made_through_hole(0.1f, 0.003f, 40, floor);
  CHECK(loose.masks < strict.masks / 2);
  CHECK(loose.rms * loose.light < 1.2 * 0.003 * double(floor));
  CHECK(std::abs(loose.bias) < 0.01);
  // a floor below the light changes nothing
  const Made same = made_through_hole(0.1f, 0.003f, 40, 0.5f * float(strict.light));
  CHECK(same.masks == strict.masks);
}

TEST_CASE("masks: no more source cells than pay off, and none where all is open") {
  OneSource one(receivers_on_floor(8, 0.01f));
  one.options.mask_error = 0.001f;
  const FlatCell whole = visible_part(one.source, one.cluster.hull);
  const std::vector<float> nothing(64, 0);
  SourcePart part;
  part.members = one.members;
  part.hull = one.cluster.hull;
  part.cell = whole;
  for (const Quad& q : plane_with_hole(0, 0, 0.3f, 1)) part.facets.push_back({q, 0, false});
  PilotMemory pilots;
  SettleMemory settle;
  std::vector<PlannedCell> cells;
  const auto cells_within = [&](double budget) {
    SourceTask task = one.task();
    task.promise = {one.options.mask_error, budget, nothing, nothing, nothing};
    plan_cells(task, part, 1, pilots, settle, cells);
    double area = 0;
    for (const PlannedCell& c : cells) area += length(cross(c.cell.plane.u, c.cell.plane.v));
    CHECK(area == doctest::Approx(1));
    return cells.size();
  };
  CHECK(cells_within(10) == 1);
  CHECK(cells_within(1e9) > 8);
  part.facets.resize(1);
  part.facets[0].quad = {Vec3{5, 5, 1}, {6, 5, 1}, {6, 6, 1}, {5, 6, 1}};
  CHECK(cells_within(1e9) == 1);
}

TEST_CASE("masks: facets that a source cell's list leaves out do not hide the cell") {
  Random random(11);
  size_t all = 0, kept = 0, segments = 0;
  for (int scene = 0; scene < 300; ++scene) {
    const FlatSource source = random_source(random);
    OneSource one(random_receivers(random, 16), source);
    FlatCell cell = visible_part(source, one.cluster.hull);
    if (cell.corner_count == 0) continue;
    for (int k = 0; k < 3; ++k) {
      FlatCell first, second;
      if (halve(cell, first, second)) cell = random.next_float() < 0.5f ? first : second;
    }
    BruteForceScene world;
    for (int k = 0; k < 6; ++k) add_random_facets(random, world);
    std::vector<FacetToAdd> facets, before;
    for (uint32_t i = 0; i < world.facets.size(); ++i)
      facets.push_back({world.facets[i], i, false});
    facets_for_cell(one.cluster.hull, cell, facets, before);
    all += facets.size();
    kept += before.size();
    std::vector<uint8_t> is_kept(facets.size(), 0);
    for (const FacetToAdd& f : before) is_kept[f.id] = 1;
    const CellPoints points(cell);
    for (int k = 0; k < 100; ++k) {
      const Vec3d from(one.receivers[size_t(k) % 16].origin);
      const Vec3d to = points.at(random.next_float(), random.next_float());
      for (size_t i = 0; i < facets.size(); ++i) {
        if (is_kept[i] != 0) continue;
        ++segments;
        REQUIRE(meets(from, to, facets[i].quad, 1e-7) != 1);
      }
    }
  }
  CHECK(segments > 100000);
  CHECK(kept < 0.8 * double(all));
}

}  // namespace test_plan_cells
