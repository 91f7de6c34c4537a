// Bright patches by certified visibility: nothing counted twice, nothing lost, and their shadows.
#include "integrate/certified_patches.h"

#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "probe.h"
#include "radiosity/solver.h"
#include "radiosity/source_contributions.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// Every patch that a point kept, and from which any light arrives.
SelectionOptions with_all_patches() {
  SelectionOptions o = certified_selection(true);
  o.nearest_patch = 0;
  o.thresholds.visible_above = 2;
  o.thresholds.major_share = o.thresholds.shadow_edge = 1e-4f;
  return o;
}

struct Prepared {
  Prepared(Scene s, float element, uint32_t stored)
      : scene(std::move(s)), solution(solve(scene, element, stored)) {}
  static RadiositySolution solve(const PreparedScene& scene, float element, uint32_t stored) {
    RadiosityOptions o;
    o.meshing.element_size = element;
    o.meshing.patch_size = 4 * element;
    o.stored_per_point = stored;
    o.tolerance = 1e-3f;
    return solve_radiosity(scene.scene, scene.tracer, scene.bsdf_tables, scene.primitives, o, 2, {},
                           StopFlag{false});
  }
  SourceSelection select(const SelectionOptions& options) const {
    return SourceSelection(solution, scene.tracer, scene.primitives, options, 2, StopFlag{false});
  }
  const PreparedScene scene;
  const RadiositySolution solution;
};

// The method with one selection.
struct Certified {
  Certified(const Prepared& p, const SelectionOptions& options)
      : selection(p.select(options)),
        radiosity(p.scene, p.solution, selection),
        integrator(certified_integrator(p.scene, 0.01, &radiosity)),
        patches(p.scene, p.solution, selection) {}
  const SourceSelection selection;
  const RadiosityLight radiosity;
  const WaveIntegrator integrator;
  const CertifiedPatches patches;
};

// 4 × 3 × 2.5 m, grey; a lamp near the ceiling shines up, so that all else is lit by it.
Scene uplight_room() {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f, 0.6f, 0.4f});
  add_box_inside(s, grey, {0, 0, 0}, {4, 3, 2.5f});
  const uint32_t lamp =
      add_quad(s, add_diffuse(s, Rgb{0}),
               {Vec3{1.8f, 1.3f, 2}, {2.2f, 1.3f, 2}, {2.2f, 1.7f, 2}, {1.8f, 1.7f, 2}});
  make_light(s, lamp, Rgb{60});
  return s;
}

// The same room with a lamp in the ceiling: nothing hides anything.
Scene open_room() {
  Scene s;
  add_box_inside(s, add_diffuse(s, Rgb{0.5f, 0.6f, 0.4f}), {0, 0, 0}, {4, 3, 2.5f});
  const uint32_t lamp =
      add_quad(s, add_diffuse(s, Rgb{0}),
               {Vec3{1.2f, 1, 2.499f}, {1.2f, 2, 2.499f}, {2.2f, 2, 2.499f}, {2.2f, 1, 2.499f}});
  make_light(s, lamp, Rgb{10});
  return s;
}

Scene uplight_room_with_table() {
  Scene s = uplight_room();
  add_block(s, add_diffuse(s, Rgb{0.3f}), {1.4f, 1, 0.7f}, {2.6f, 2, 0.75f});
  return s;
}

// Indirect light that an eye sees at points, one after the other.
std::vector<double> indirect_at(const Integrator& integrator, const Vec3& place,
                                const std::vector<Vec3>& points, uint32_t samples, int sets = 4) {
  std::vector<double> light;
  for (const Vec3& x : points)
    light.push_back(probe(integrator, ray_towards(place, x), samples, sets).indirect.mean());
  return light;
}

double rms(const std::vector<double>& a, const std::vector<double>& b, double& mean) {
  double squares = 0, all = 0;
  mean = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    squares += sqr(a[i] - b[i]);
    mean += a[i] - b[i];
    all += b[i];
  }
  mean /= all;
  return std::sqrt(squares / double(a.size())) / (all / double(a.size()));
}

}  // namespace

TEST_CASE("certified patches: in the open, patches as sources add up to the general value") {
  const Prepared room(open_room(), 0.25f, 24);
  const Certified general(room, certified_selection(false)), promoted(room, with_all_patches());
  REQUIRE(general.patches.is_empty());
  REQUIRE(!promoted.patches.is_empty());
  std::vector<Vec3> points;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 4; ++j)
      points.push_back({0.6f + 0.56f * float(i), 0.6f + 0.6f * float(j), 0});
  const Vec3 eye{0.3f, 0.3f, 1.2f};
  const auto a = indirect_at(general.integrator, eye, points, 1, 1);
  const auto b = indirect_at(promoted.integrator, eye, points, 32);
  double mean = 0;
  const double error = rms(b, a, mean);
  // what is left as general light shows that the test is not about nothing
  double kept = 0;
  for (const Vec3& x : points) {
    const Ray ray = ray_towards(eye, x);
    Hit hit;
    room.scene.tracer.closest({&ray, 1}, {&hit, 1});
    Vertex v;
    make_vertex(room.scene.scene, ray, hit, v);
    const RadiosityLight of(room.scene, room.solution, promoted.selection),
        all(room.scene, room.solution, general.selection);
    kept += double(of.general(of.place_of(hit, v)).indirect.g) /
            double(all.general(all.place_of(hit, v)).indirect.g) / double(points.size());
  }
  MESSAGE("rms ", error, ", mean ", mean, ", left as general ", kept);
  CHECK(kept < 0.6);
  CHECK(error < 0.004);
  CHECK(std::abs(mean) < 0.002);
}

TEST_CASE("certified patches: the shadow of a table in light from the ceiling, as paths have it") {
  const Prepared room(uplight_room_with_table(), 0.5f, 16);
  const Certified general(room, certified_selection(false)),
      promoted(room, certified_selection(true));
  REQUIRE(!promoted.patches.is_empty());
  std::vector<Vec3> points;  // from under the table out into the open
  for (int i = 0; i < 10; ++i) points.push_back({0.4f + 0.17f * float(i), 1.35f, 0});
  const Vec3 eye{0.6f, 0.2f, 0.5f};
  const PathIntegrator path(room.scene, PathOptions{});
  const auto wanted = indirect_at(path, eye, points, 4096, 8);
  double mean_general = 0, mean_promoted = 0;
  const auto seen = indirect_at(promoted.integrator, eye, points, 64);
  const double error_general =
      rms(indirect_at(general.integrator, eye, points, 1, 1), wanted, mean_general);
  const double error = rms(seen, wanted, mean_promoted);
  MESSAGE("rms ", error_general, " by the general value, ", error, " with patches; means ",
          mean_general, ", ", mean_promoted);
  CHECK(wanted.back() < 0.5 * wanted.front());  // there is a shadow
  // What patches err by did not change when the general value came nearer (middles of elements).
  CHECK(error < 0.02);
  CHECK(error < 0.6 * error_general);
}

TEST_CASE("certified patches: a patch sends what its elements hold") {
  const Prepared room(uplight_room_with_table(), 0.25f, 16);
  const SourceSelection selection = room.select(certified_selection(true));
  uint32_t uneven = 0;
  for (uint32_t p = 0; p < room.solution.mesh.patches.size(); ++p) {
    const Shooter shooter = whole_patch_shooter(room.solution, p);
    if (shooter.pieces.empty() || shooter.share.empty()) continue;
    ++uneven;
    PatchSource source;
    source.radiance = room.solution.shot_radiance[p];
    source.shooter = &shooter;
    source.points = 16;
    PatchIntegrand integrand;
    integrand.sources().push_back(&source);
    CHECK(PatchIntegrand::points_for(shooter) <= 64);
    // the mean over the patch is what it shot
    std::vector<Vec3> points;
    for (uint32_t k = 0; k < 1024; ++k)
      points.push_back(point_on(shooter.pieces[0], SobolGroup(5, p, k).get2()));
    std::vector<Rgb> values(points.size());
    integrand.evaluate(0, 0, points, values);
    Rgb sum;
    for (const Rgb& v : values) sum += v / float(values.size());
    if (shooter.pieces.size() == 1)
      CHECK(sum.g == doctest::Approx(room.solution.shot_radiance[p].g).epsilon(0.05));
    if (uneven >= 40) break;
  }
  CHECK(uneven >= 20);
}

TEST_CASE("certified patches: what a scratch was used for before leaves no trace") {
  const Prepared room(uplight_room_with_table(), 0.5f, 16);
  const Certified promoted(room, certified_selection(true));
  const Integrator& mine = promoted.integrator;
  const auto used = mine.make_scratch(), fresh = mine.make_scratch();
  RadianceBatch first, second;
  Counters counters;
  const Vec3 eye{0.6f, 0.2f, 0.5f};
  for (const Vec3& x : {Vec3{1.5f, 1.4f, 0}, Vec3{1.2f, 1.2f, 0}}) {
    const ViewingRays rays = repeated(ray_towards(eye, x), 3, 50);
    first.reset(rays.size());
    second.reset(rays.size());
    mine.radiance(rays, *used, first, counters);
    mine.radiance(rays, *mine.make_scratch(), second, counters);
    for (size_t i = 0; i < rays.size(); ++i) {
      CHECK(first.indirect[i].g == second.indirect[i].g);
      CHECK(first.indirect[i].g > 0);
    }
  }
}
