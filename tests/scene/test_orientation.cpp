// Decisions on which way is up: by format, by evidence, and the messages when these disagree.
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "scene/orientation.h"

using namespace troffer;

namespace test_orientation {

namespace {

// Builds scenes with y up; z_up() turns them.
struct Builder {
  Scene scene;

  explicit Builder(const std::string& file) {
    scene.file = file;
    scene.materials.resize(1);
  }
  Mesh& quad(const std::array<Vec3, 4>& p, const std::string& name = "mesh") {
    Mesh m;
    m.name = name;
    m.positions.assign(p.begin(), p.end());
    m.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.meshes.push_back(m);
    return scene.meshes.back();
  }
  Mesh& level(float y, float x0, float x1, float z0, float z1, const std::string& name = "mesh") {
    return quad({Vec3{x0, y, z0}, Vec3{x0, y, z1}, Vec3{x1, y, z1}, Vec3{x1, y, z0}}, name);
  }
  void box(const Vec3& lower, const Vec3& size) {
    const Vec3 u = lower + size;
    Mesh m;
    m.name = "box";
    for (int i = 0; i < 8; ++i)
      m.positions.push_back({(i & 1) != 0 ? u.x : lower.x, (i & 2) != 0 ? u.y : lower.y,
                             (i & 4) != 0 ? u.z : lower.z});
    const std::array<std::array<uint32_t, 4>, 6> faces{
        {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}};
    for (const auto& f : faces) {
      m.triangles.push_back({f[0], f[1], f[2]});
      m.triangles.push_back({f[0], f[2], f[3]});
    }
    scene.meshes.push_back(m);
  }
  // Six walls of one quad each, from the origin to `s`.
  void room(const Vec3& s) {
    level(0, 0, s.x, 0, s.z);
    level(s.y, 0, s.x, 0, s.z);
    for (const float x : {0.0f, s.x})
      quad({Vec3{x, 0, 0}, Vec3{x, s.y, 0}, Vec3{x, s.y, s.z}, Vec3{x, 0, s.z}});
    for (const float z : {0.0f, s.z})
      quad({Vec3{0, 0, z}, Vec3{s.x, 0, z}, Vec3{s.x, s.y, z}, Vec3{0, s.y, z}});
  }
  void desk(float x, float z) {
    for (const float dx : {0.0f, 1.1f})
      for (const float dz : {0.0f, 0.7f}) box({x + dx, 0, z + dz}, {0.05f, 0.7f, 0.05f});
    box({x, 0.7f, z}, {1.15f, 0.04f, 0.75f});
  }
  // A square that emits downwards.
  void lamp(float x, float y, float z) {
    Mesh& m = quad(
        {Vec3{x, y, z}, Vec3{x + 0.6f, y, z}, Vec3{x + 0.6f, y, z + 0.6f}, Vec3{x, y, z + 0.6f}});
    m.lights = {int32_t(scene.lights.size()), int32_t(scene.lights.size())};
    Light e;
    e.name = "lamp";
    e.radiance = Rgb{10};
    e.geometry = uint32_t(scene.meshes.size() - 1);
    e.triangles = {0, 1};
    scene.lights.push_back(e);
  }
  void camera(const Vec3& forward, const Vec3& right) {
    Camera c;
    c.forward = normalize(forward);
    c.right = normalize(right);
    c.up = cross(c.right, c.forward);
    scene.cameras.push_back(c);
  }
};

// Turns y to z and z to -y.
Vec3 turned(const Vec3& v) {
  return {v.x, -v.z, v.y};
}

Scene z_up(Scene s) {
  for (Mesh& m : s.meshes)
    for (Vec3& p : m.positions) p = turned(p);
  for (Camera& c : s.cameras)
    for (Vec3* v : {&c.position, &c.right, &c.up, &c.forward}) *v = turned(*v);
  for (Light& e : s.lights) {
    e.direction = turned(e.direction);
    for (Vec3& a : e.axes) a = turned(a);
  }
  return s;
}

const Vec3 y{0, 1, 0}, z{0, 0, 1};

// Checks that y is found in the scene and z in the turned one.
void check_both(const Scene& scene, const std::string& reason) {
  const UpDecision straight = decide_up(scene), other = decide_up(z_up(scene));
  CHECK(straight.up == y);
  CHECK(straight.reason == reason);
  CHECK(straight.basis == UpBasis::evidence);
  CHECK(other.up == z);
  CHECK(other.reason == reason);
  CHECK(other.doubt == "");
}

}  // namespace

TEST_CASE("furniture on a floor indicates up, whatever the proportions of a room") {
  for (const char* file : {"a.obj", "a.ply", "a.stl", "a.pbrt", "a.xml", "A.OBJ.gz"})
    for (const Vec3& size : {Vec3{10, 3, 2}, Vec3{4, 3, 8}, Vec3{3, 9, 3}, Vec3{5, 5, 5}}) {
      CAPTURE(file);
      Builder b(file);
      b.room(size);
      b.desk(0.3f, 0.3f);
      b.desk(1.6f, 0.3f);
      check_both(b.scene, "by objects that stand on others");
    }
}

TEST_CASE("a cupboard that hangs on a wall does not outweigh what stands on the floor") {
  Builder b("a.obj");
  b.room({6, 3, 5});
  b.desk(1, 2);
  b.box({2, 1.5f, 0}, {1, 0.8f, 0.4f});
  b.box({4, 1.5f, 0}, {1, 0.8f, 0.4f});
  check_both(b.scene, "by objects that stand on others");
}

TEST_CASE("a lamp in the ceiling of an empty corridor indicates up") {
  Builder b("a.obj");
  b.room({10, 3, 2});
  b.lamp(4, 2.99f, 0.7f);
  check_both(b.scene, "by a lamp that faces down");
}

TEST_CASE("cameras indicate up, level and tilted ones") {
  for (const Vec3& forward : {Vec3{1, 0, 0.3f}, Vec3{1, -0.5f, 0.3f}, Vec3{0.2f, -1, 0.3f}}) {
    Builder b("a.pbrt");
    b.room({4, 7, 4});
    b.camera(forward, cross(forward, y));
    check_both(b.scene, "by its camera");
  }
}

TEST_CASE("names of floors and ceilings indicate up") {
  for (const char* name : {"floor", "Floor.001", "Boden", "officeFloor", "wood_floor_12"}) {
    Builder b("a.obj");
    b.room({10, 3, 2});
    b.level(0.001f, 0, 10, 0, 2, name);
    check_both(b.scene, "by the name of its floor");
  }
  Builder b("a.obj");
  b.room({10, 3, 2});
  b.level(0.001f, 0, 10, 0, 2, "floor");
  b.level(2.99f, 0, 10, 0, 2, "Ceiling");
  check_both(b.scene, "by the names of floor and ceiling");
}

TEST_CASE("a floor lamp is no floor") {
  Builder b("a.obj");
  b.room({10, 3, 2});
  b.quad({Vec3{0, 0, 0}, Vec3{0.2f, 0, 0}, Vec3{0.2f, 1.6f, 0}, Vec3{0, 1.6f, 0}}, "floor lamp");
  CHECK(decide_up(b.scene).basis == UpBasis::convention);
}

TEST_CASE("a ground with something on it indicates up") {
  Builder b("a.pbrt");
  b.level(0, -5, 5, -5, 5);
  b.box({0, 0, 0}, {2, 12, 2});
  const UpDecision d = decide_up(b.scene);
  CHECK(d.up == y);
  CHECK(d.reason == "by the ground below all else and an object that stands on another");
  CHECK(decide_up(z_up(b.scene)).up == z);
}

TEST_CASE("a sky of the file indicates up") {
  Builder b("a.xml");
  b.room({10, 3, 2});
  Light sky;
  sky.kind = LightKind::sky;
  sky.axes = {Vec3{1, 0, 0}, Vec3{0, 0, -1}, y};
  b.scene.lights.push_back(sky);
  check_both(b.scene, "by its sky");
}

TEST_CASE("an empty box gives no hint, and the note says so") {
  Builder b("tower.obj");
  b.room({20, 20, 60});
  const UpDecision d = decide_up(b.scene);
  CHECK(d.up == y);
  CHECK(d.basis == UpBasis::convention);
  CHECK(d.doubt ==
        "nothing in the file says which way is up: y is taken, as in most OBJ files "
        "(--up z if it stands on z)");
  b.scene.file = "tower.stl";
  CHECK(decide_up(b.scene).doubt ==
        "nothing in the file says which way is up: z is taken, as in most STL files "
        "(--up y if it stands on y)");
}

TEST_CASE(
    "glTF and Radiance define which way is up; a scene that lies on its side causes a warning") {
  Builder b("a.gltf");
  b.room({6, 3, 5});
  b.desk(1, 2);
  b.desk(3, 2);
  b.level(0.001f, 0, 6, 0, 5, "floor");
  CHECK(describe(decide_up(b.scene)) == "y is up, by the glTF format");
  CHECK(decide_up(b.scene).doubt == "");
  const UpDecision lying = decide_up(z_up(b.scene));
  CHECK(lying.up == y);
  CHECK(
      lying.doubt ==
      "y is taken for up, by the glTF format, but z is up by objects that stand on others and the "
      "name of its floor (--up z takes that)");
  b.scene.file = "a.rad";
  CHECK(describe(decide_up(z_up(b.scene))) == "z is up, by the Radiance format");
  CHECK(decide_up(z_up(b.scene)).doubt == "");
}

TEST_CASE("contradicting hints leave a doubt") {
  Builder b("a.pbrt");
  b.room({6, 3, 5});
  b.level(0.001f, 0, 6, 0, 5, "floor");
  b.camera({1, 0.3f, 0.1f}, cross(Vec3{1, 0.3f, 0.1f}, z));
  const UpDecision d = decide_up(b.scene);
  CHECK(d.doubt ==
        "which way is up is in doubt: y by the name of its floor, z by its camera; y is taken "
        "(--up z takes the other)");
}

TEST_CASE("directions have names") {
  CHECK(name_of_up({0, 1, 0}) == "y");
  CHECK(name_of_up({0, 0, -2}) == "-z");
  CHECK(name_of_up({0.6f, 0, 0.8f}) == "0.6,0,0.8");
}

}  // namespace test_orientation
