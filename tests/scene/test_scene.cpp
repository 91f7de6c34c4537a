// Counts, bounds and selection of lights.
#include <doctest/doctest.h>

#include "base/error.h"
#include "scene/scene.h"

using namespace troffer;

namespace {

// Two meshes, a sphere and a disk; lights "lamp" (mesh 0), "lamp" (sphere), "desk" (mesh 1).
Scene small() {
  Scene s;
  s.materials.resize(1);
  Mesh m;
  m.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  m.triangles = {{0, 1, 2}, {1, 3, 2}};
  m.lights = {0, no_light};
  s.meshes.push_back(m);
  m.lights = {2, 2};
  s.meshes.push_back(m);
  Sphere sphere;
  sphere.centre = {5, 0, 0};
  sphere.radius = 2;
  sphere.light = 1;
  s.spheres.push_back(sphere);
  Disk disk;
  disk.centre = {0, 0, 10};
  disk.normal = {0, 0.6f, 0.8f};
  disk.radius = 3;
  s.disks.push_back(disk);
  for (const char* name : {"lamp", "lamp", "desk"}) {
    s.lights.emplace_back();
    s.lights.back().name = name;
    s.lights.back().radiance = Rgb{float(s.lights.size())};
  }
  return s;
}

}  // namespace

TEST_CASE("triangle count and bounds include everything") {
  const Scene s = small();
  CHECK(triangle_count(s) == 4);
  const Box b = bounds(s);
  CHECK(b.upper.x == 7);
  CHECK(b.lower.x == -3);
  CHECK(b.lower.z == -2);
  CHECK(b.upper.z == doctest::Approx(10 + 3 * 0.6));
  CHECK(b.upper.y == doctest::Approx(3 * 0.8));
  CHECK(bounds(Scene{}).is_empty());
  // only vertices that triangles use count
  Scene loose = small();
  loose.meshes[0].positions.push_back({100, 100, 100});
  CHECK(bounds(loose).upper.x == 7);
}

TEST_CASE("emitters are selected by name, all of one name together") {
  const Scene lamps = with_only_lights(small(), {"lamp"});
  REQUIRE(lamps.lights.size() == 2);
  CHECK(lamps.lights[1].radiance == Rgb{2});
  CHECK(lamps.meshes[0].lights == std::vector<int32_t>{0, no_light});
  CHECK(lamps.meshes[1].lights == std::vector<int32_t>{no_light, no_light});
  CHECK(lamps.spheres[0].light == 1);
  CHECK(lamps.disks[0].light == no_light);

  const Scene desk = with_only_lights(small(), {"desk", "desk"});
  REQUIRE(desk.lights.size() == 1);
  CHECK(desk.lights[0].name == "desk");
  CHECK(desk.meshes[0].lights[0] == no_light);
  CHECK(desk.meshes[1].lights == std::vector<int32_t>{0, 0});
  CHECK(desk.spheres[0].light == no_light);

  CHECK(with_only_lights(small(), {"desk", "lamp"}).lights.size() == 3);
  CHECK(with_only_lights(small(), {}).lights.empty());
}

TEST_CASE("an unknown light is a usage error with its name") {
  try {
    with_only_lights(small(), {"lamp", "chandelier"});
    FAIL("no error");
  } catch (const UsageError& e) {
    CHECK(std::string(e.what()).find("chandelier") != std::string::npos);
  }
}

TEST_CASE("emission leaves the front, or both sides, times its texture") {
  Scene s = small();
  Light e;
  e.radiance = {2, 4, 8};
  CHECK(emitted_radiance(s, e, true, Vec2{0, 0}) == Rgb{2, 4, 8});
  CHECK(emitted_radiance(s, e, false, Vec2{0, 0}) == Rgb{0});
  e.is_two_sided = true;
  CHECK(emitted_radiance(s, e, false, Vec2{0, 0}) == Rgb{2, 4, 8});
  s.textures.emplace_back();
  s.textures[0].value = {0.5f, 0.25f, 0};
  e.texture = 0;
  CHECK(emitted_radiance(s, e, true, Vec2{0, 0}) == Rgb{1, 1, 0});
}
