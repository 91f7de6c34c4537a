// Tests of the choice of a scene's origin, and that every importer applies it in double precision.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cstring>

#include "import/gltf_builder.h"
#include "import/mesh/obj.h"
#include "import/mesh/ply.h"
#include "import/pbrt/pbrt.h"
#include "import/recentre.h"
#include "import/temp_folder.h"

using namespace troffer;

namespace test_recentre {

namespace {

Boxd box_around(const Vec3d& middle, double side) {
  return {middle - Vec3d{side / 2}, middle + Vec3d{side / 2}};
}

bool is_same(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3)) == 0;
}

Scene pbrt(const std::string& text) {
  const TempFolder folder;
  return import_pbrt(folder.write("scene.pbrt", text));
}

std::string text_of(const Vec3d& p) {
  return fmt::format(" {:.9f} {:.9f} {:.9f} ", p.x, p.y, p.z);
}

}  // namespace

TEST_CASE("the origin is zero near it, and moves with a scene by whole steps") {
  CHECK(choose_origin(Boxd()) == Vec3d{});
  for (const double side : {1e-3, 0.2, 3.0, 50.0, 130.0, 2000.0}) {
    CAPTURE(side);
    CHECK(choose_origin(box_around(Vec3d{0.9 * side}, side)) == Vec3d{});
    for (const Vec3d& by : {Vec3d{10000, 0, -10000}, Vec3d{5000, 5000, 5000}, Vec3d{0, 1e6, 0}})
      CHECK(choose_origin(box_around(Vec3d{0.3 * side, -0.7 * side, 0} + by, side)) == by);
  }
  // The distance to the origin is in proportion to the size of the scene, wherever it lies.
  for (const double side : {1e-2, 7.0, 600.0, 40000.0}) {
    const Vec3d middle{1370043.21, -2200017.3, 330037.7};
    const Vec3d left = abs(choose_origin(box_around(middle, side)) - middle);
    CHECK(std::max({left.x, left.y, left.z}) <= std::max(side * 5, 0.6));
  }
}

TEST_CASE("pbrt: meshes, spheres, disks, instances, PLY and the camera count from the origin") {
  const TempFolder folder;
  const auto scene = [&](const Vec3d& by) {
    const auto at = [&](const Vec3d& p) { return text_of(p + by); };
    std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\n"
        "property double y\nproperty double z\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n";
    for (const Vec3d& p : {Vec3d{1.1, 2.2, 0.3}, Vec3d{1.2, 2.2, 0.3}, Vec3d{1.1, 2.3, 0.4}})
      ply += at(p) + "\n";
    ply += "3 0 1 2\n";
    folder.write("m.ply", ply);
    return import_pbrt(folder.write(
        "s.pbrt",
        "LookAt" + at({0, 0.5, 1.7}) + at({0, 0.5, 0}) +
            "0 1 0 Camera \"perspective\" WorldBegin\n"
            "Shape \"trianglemesh\" \"point3 P\" [" +
            at({-3, -3, 0}) + at({3.3, -3, 0}) + at({0.7, 3.1, 0.1}) +
            "]\nShape \"plymesh\" \"string filename\" \"m.ply\"\n"
            "Shape \"bilinearmesh\" \"point3 P\" [" +
            at({0, 0, 1}) + at({1, 0, 1.3}) + at({0, 1, 1.2}) + at({1, 1, 1}) +
            "]\n"
            "ObjectBegin \"o\" Shape \"trianglemesh\" \"point3 P\" [0 0 0 0.3 0 0 0 0.3 0]\n"
            "Shape \"sphere\" \"float radius\" 0.25 ObjectEnd\n"
            "AttributeBegin Translate" +
            at({0.4, 0.6, 1.2}) +
            "ObjectInstance \"o\"\n"
            "Shape \"disk\" \"float height\" 0.1 AttributeEnd\n"));
  };
  const Scene near = scene({});
  CHECK(near.origin == Vec3d{});
  REQUIRE(near.meshes.size() == 4);
  for (const Vec3d& by : {Vec3d{5000, 5000, 0}, Vec3d{-10000, 20000, 10000}}) {
    const Scene far = scene(by);
    CHECK(far.origin == by);
    REQUIRE(far.meshes.size() == near.meshes.size());
    for (size_t m = 0; m < near.meshes.size(); ++m) {
      CAPTURE(m);
      CHECK(is_same(far.meshes[m].positions, near.meshes[m].positions));
    }
    CHECK(far.spheres.at(0).centre == near.spheres.at(0).centre);
    CHECK(far.disks.at(0).centre == near.disks.at(0).centre);
    CHECK(far.cameras.at(0).position == near.cameras.at(0).position);
    CHECK(far.cameras.at(0).forward == near.cameras.at(0).forward);
    CHECK(far.warnings.entries().size() == near.warnings.entries().size());
    const Boxd box = bounds_in_file(far);
    CHECK(box.lower == Vec3d(bounds(near).lower) + by);
  }
}

TEST_CASE("glTF: nodes far away, one within the other") {
  const auto scene = [](double x) {
    return import_text(
        square_scene(fmt::format("[{{'children':[1,2],'translation':[{},0,0]}},"
                                 "{{'mesh':0,'translation':[0.3,0.2,0.1]}},{{'camera':0,"
                                 "'translation':[0.5,0.5,2]}}]",
                                 x),
                     "'materials':[{}],'cameras':[{'type':'perspective','perspective':{'yfov':1,'"
                     "znear':0.1}}]"));
  };
  const Scene near = scene(0), far = scene(10000);
  CHECK(far.origin == Vec3d{10000, 0, 0});
  CHECK(is_same(far.meshes.at(0).positions, near.meshes.at(0).positions));
  CHECK(far.cameras.at(0).position == near.cameras.at(0).position);
}

TEST_CASE("OBJ: a polygon far away; triangles without area do not count") {
  const TempFolder folder;
  const auto scene = [&](const Vec3d& by) {
    std::string text = "v 1e7 1e7 1e7\n";
    for (const Vec3d& p : {Vec3d{0.1, 0.1, 0}, Vec3d{2.1, 0.1, 0}, Vec3d{2.1, 2.2, 0},
                           Vec3d{1.1, 0.4, 0}, Vec3d{0.1, 2.2, 0}})
      text += "v" + text_of(p + by) + "\n";
    return import_obj(folder.write("m.obj", text + "f 2 3 4 5 6\nf 1 1 1\n"));
  };
  const Scene near = scene({}), far = scene({5000, 10000, 0});
  CHECK(near.origin == Vec3d{});
  CHECK(far.origin == Vec3d{5000, 10000, 0});
  CHECK(far.meshes.at(0).triangles == near.meshes.at(0).triangles);
  const auto corners = [](const Scene& s) {
    std::vector<Vec3> out;
    for (const Triangle& t : s.meshes.at(0).triangles)
      for (const uint32_t v : t) out.push_back(s.meshes[0].positions[v]);
    return out;
  };
  CHECK(corners(near).size() == 9);
  CHECK(is_same(corners(far), corners(near)));
}

TEST_CASE("a scene too large for floats causes a warning with the rounding step") {
  const auto triangle = [](double side, double x) {
    return pbrt(fmt::format(
        "WorldBegin Shape \"trianglemesh\" \"point3 P\" [{0} 0 0 {1} 0 0 {0} 1 0]", x, x + side));
  };
  CHECK(has_warning(triangle(100'000, 0), "100000 across"));
  CHECK(has_warning(triangle(100'000, 0), "steps of 0.0078"));
  CHECK_FALSE(has_warning(triangle(1000, 0), "across"));
  CHECK_FALSE(has_warning(triangle(1000, 1e6), "across"));
}

}  // namespace test_recentre
