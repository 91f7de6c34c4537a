// The foot of walls: a floor that continues below them shows, in the lit room, the light that
// `measure` finds there. Expected values: troffer measure --method path of the same scenes.
#include <doctest/doctest.h>

#include <cmath>

#include "bake/bake.h"
#include "import/import.h"
#include "render/measure.h"
#include "support/scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace test_rim {

namespace {

const StopFlag never_stop = false;

BakeResult baked(Scene scene, int resolution, int samples) {
  BakeOptions o;
  o.atlas.resolution = resolution;
  o.samples = samples;
  o.light.threads = 2;
  const PreparedScene prepared(as_meshes(std::move(scene)));
  BakeResult r = bake(prepared, o, {}, never_stop);
  REQUIRE(r.is_complete);
  return r;
}

Scene room(const std::string& name) {
  return import_scene(std::string(TROFFER_SOURCE_DIR "/tests/bake/rim/") + name);
}

// Samples an image bilinearly.
double light_at(const Image& image, const Vec2& uv) {
  const double x = double(uv.x) * image.width - 0.5, y = double(uv.y) * image.height - 0.5;
  const int x0 = int(std::floor(x)), y0 = int(std::floor(y));
  double sum = 0;
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i)
      sum += double(luminance(image.at(x0 + i, y0 + j))) * (i == 1 ? x - x0 : 1 - x + x0) *
             (j == 1 ? y - y0 : 1 - y + y0);
  return sum;
}

// Returns the light that the lightmap shows at a place of the floor, which lies at y = 0, as seen
// from above.
double light_on_floor(const BakeResult& r, double x, double z) {
  const Vec3d at(x, 0, z);
  for (size_t m = 0; m < r.scene.meshes.size(); ++m) {
    const Mesh& mesh = r.scene.meshes[m];
    const BakedSurface& surface = r.baked.meshes[m];
    if (surface.page < 0 || mesh.name != "floor") continue;
    for (const Triangle& t : mesh.triangles) {
      const Vec3d a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
      const Vec3d n = cross(b - a, c - a);
      if (n.y <= 0) continue;
      const double u = dot(cross(b - at, c - at), n) / dot(n, n),
                   v = dot(cross(c - at, a - at), n) / dot(n, n), w = 1 - u - v;
      if (u < -1e-6 || v < -1e-6 || w < -1e-6) continue;
      return light_at(r.irradiance[size_t(surface.page)], surface.uvs[t[0]] * float(u) +
                                                              surface.uvs[t[1]] * float(v) +
                                                              surface.uvs[t[2]] * float(w));
    }
  }
  FAIL("no floor there");
  return 0;
}

}  // namespace

namespace {

// Mean light along a wall at x = 3.9, at 31 places from z = .5 to 3.5. Single texels have too much
// noise for a close comparison.
double mean_along_wall(const BakeResult& r, double x) {
  double sum = 0;
  for (int i = 0; i <= 30; ++i) sum += light_on_floor(r, x, 0.5 + 0.1 * i);
  return sum / 31;
}

}  // namespace

TEST_CASE("a floor keeps its light at the foot of walls that reach the ceiling") {
  for (const char* name : {"open-sheets.gltf", "closed-box.gltf"}) {
    for (const int resolution : {128, 256}) {
      CAPTURE(name);
      CAPTURE(resolution);
      const BakeResult r = baked(room(name), resolution, 32);
      CHECK(light_on_floor(r, 3.895, 2) == doctest::Approx(458.6).epsilon(0.06));
      CHECK(light_on_floor(r, 3.88, 2) == doctest::Approx(463.6).epsilon(0.06));
      if (resolution < 256) continue;
      // Path tracing gives these values ± .4. The mean of a row of texels with 32 samples each has
      // a standard error of .4 %.
      CHECK(mean_along_wall(r, 3.895) == doctest::Approx(422.6).epsilon(0.016));
      CHECK(mean_along_wall(r, 3.88) == doctest::Approx(426.9).epsilon(0.016));
    }
  }
}

TEST_CASE("a wall that ends below the ceiling does not darken the floor either") {
  const BakeResult r = baked(room("free-standing.gltf"), 128, 32);
  const double near = light_on_floor(r, 3.895, 2), far = light_on_floor(r, 3.7, 2);
  CHECK(near > 0.8 * far);
}

TEST_CASE("at a wall without thickness the lit side keeps its light and the dark side stays dark") {
  Scene scene = room("open-sheets.gltf");
  for (uint32_t i = 0; i < scene.meshes.size(); ++i) {
    if (scene.meshes[i].name != "b") continue;
    scene.meshes.erase(scene.meshes.begin() + i);
    for (Light& e : scene.lights)
      if (e.geometry > i) --e.geometry;
    break;
  }
  const BakeResult r = baked(std::move(scene), 256, 32);
  CHECK(light_on_floor(r, 3.88, 2) == doctest::Approx(463.6).epsilon(0.06));
  CHECK(light_on_floor(r, 4.3, 2) < 5);
}

namespace {

// Adds the outside of a box that stands on the floor, without its bottom.
void add_body(Scene& s, uint32_t material, const Vec3& a, const Vec3& b) {
  for (size_t axis = 0; axis < 3; ++axis)
    for (const bool is_high : {false, true}) {
      if (axis == 1 && !is_high) continue;
      const size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
      std::array<Vec3, 4> p;
      for (size_t k = 0; k < 4; ++k) {
        p[k][axis] = is_high ? b[axis] : a[axis];
        p[k][u] = k == 1 || k == 2 ? b[u] : a[u];
        p[k][v] = k >= 2 ? b[v] : a[v];
      }
      if (!is_high) std::swap(p[1], p[3]);
      add_quad(s, material, p);
    }
}

// Two lit rooms on one floor, one ten times as bright as the other. A wall of 10 cm divides them,
// another meets it in the brighter room, and a cupboard stands through wall and floor.
Scene rooms_that_share_a_wall() {
  Scene s;
  s.is_photometric = true;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  const auto sides = add_box_inside(s, grey, {0, 0, 0}, {4, 2.5f, 4});
  s.meshes[sides[2]].name = "floor";
  add_body(s, grey, {1.95f, 0, 0}, {2.05f, 2.5f, 4});
  add_body(s, grey, {1, 0, 1.95f}, {1.97f, 2.5f, 2.05f});
  add_body(s, grey, {1.6f, -0.05f, 3}, {2, 0.8f, 3.5f});
  const auto add_lamp = [&](float x, float radiance) {
    const uint32_t lamp = add_quad(
        s, add_diffuse(s, Rgb{0}),
        {Vec3{x, 2.45f, 0.5f}, {x + 0.6f, 2.45f, 0.5f}, {x + 0.6f, 2.45f, 3.5f}, {x, 2.45f, 3.5f}});
    make_light(s, lamp, Rgb{radiance});
  };
  add_lamp(0.6f, 10);
  add_lamp(2.8f, 1);
  return s;
}

}  // namespace

TEST_CASE(
    "the rim of a floor at inner corners, between two lit rooms, and at furniture in a wall") {
  const std::vector<std::array<double, 2>> places{
      {1.93, 1},    {1.9, 1},     {1.85, 1},     // wall, brighter room
      {2.07, 1},    {2.1, 1},     {2.15, 1},     // its other side, darker room
      {1.92, 1.92}, {1.88, 1.88}, {1.92, 2.08},  // inner corners
      {1.5, 1.92},  {1.5, 2.08},                 // both sides of a wall in the room
      {1.57, 3.25}, {1.52, 3.25}, {1.92, 2.97},  // front of the cupboard, corner with the wall
  };
  const PreparedScene scene(rooms_that_share_a_wall());
  std::vector<MeasuringPoint> points;
  for (const auto& [x, z] : places) points.push_back({{x, 0, z}, {0, 1, 0}});
  MeasureOptions o;
  o.method = Method::path;
  o.spp = 1 << 14;
  o.threads = 2;
  const MeasureResult right = measure(scene, points, o, {}, never_stop);
  const BakeResult r = baked(rooms_that_share_a_wall(), 256, 32);
  for (size_t i = 0; i < places.size(); ++i) {
    CAPTURE(places[i][0]);
    CAPTURE(places[i][1]);
    CHECK(light_on_floor(r, places[i][0], places[i][1]) ==
          doctest::Approx(right.values[i].illuminance_lx).epsilon(0.08));
  }
}

}  // namespace test_rim
