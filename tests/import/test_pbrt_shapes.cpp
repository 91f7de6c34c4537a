// Tests of pbrt's curved shapes that become triangles, and of materials and textures made of
// others.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "base/error.h"
#include "base/units.h"
#include "import/mesh_clean.h"
#include "import/pbrt/pbrt.h"
#include "import/subdivide_loop.h"
#include "scene_checks.h"
#include "temp_folder.h"

using namespace troffer;

namespace test_pbrt_shapes {

namespace {

Scene import_world(const std::string& world) {
  const TempFolder folder;
  return import_pbrt(folder.write("scene.pbrt", "WorldBegin\n" + world));
}

std::string reason_of(const std::string& world) {
  try {
    import_world(world);
  } catch (const InputError& e) {
    return e.reason();
  }
  return "none";
}

const std::string octahedron =
    "\"integer indices\" [0 2 4 2 1 4 1 3 4 3 0 4 2 0 5 1 2 5 3 1 5 0 3 5] "
    "\"point3 P\" [1 0 0 -1 0 0 0 1 0 0 -1 0 0 0 1 0 0 -1]";
const std::string triangle = "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]\n";

Material material_of(const std::string& text) {
  const Scene scene = import_world(text + triangle);
  return scene.materials.at(scene.meshes.at(0).material);
}

}  // namespace

TEST_CASE("loopsubdiv: a closed body becomes smooth, each level four times as fine") {
  const Scene scene = import_world("Shape \"loopsubdiv\" \"integer levels\" 3 " + octahedron);
  const Mesh& mesh = scene.meshes.at(0);
  CHECK(mesh.triangles.size() == 8 * 64);
  // A control point keeps 1 - n β of its distance from the neighbours' mean, which is the centre; n
  // = 4, β = 3/32. The limit is still closer.
  const double once = 1 - 4 * 3.0 / 32;
  CHECK(double(bounds(scene).upper.x) > 0.3);
  CHECK(double(bounds(scene).upper.x) < once);
  for (size_t i = 0; i < mesh.positions.size(); ++i)
    CHECK(dot(normalize(mesh.positions[i]), mesh.normals[i]) > 0.9f);
}

TEST_CASE(
    "subdivision agrees with a calculation by hand: edge points of a triangle, and fixed limit "
    "points") {
  Mesh one;
  one.positions = {{0, 0, 0}, {8, 0, 0}, {0, 8, 0}};
  one.triangles = {{0, 1, 2}};
  // Every vertex has two neighbours along the boundary, a cubic B-spline: 2/3 of its own position,
  // 1/6 of each neighbour's.
  const Mesh limit = subdivide_loop(one, 0);
  CHECK(is_near(limit.positions.at(0), {4 / 3.0f, 4 / 3.0f, 0}));
  // The limit of the corner does not depend on the number of subdivisions.
  CHECK(is_near(subdivide_loop(one, 4).positions.at(0), {4 / 3.0f, 4 / 3.0f, 0}, 1e-4f));
  CHECK(subdivide_loop(one, 2).triangles.size() == 16);
  // A flat mesh stays flat with the same front; triangles that repeat a corner are left out.
  one.triangles.push_back({1, 1, 2});
  for (const Vec3& n : subdivide_loop(one, 2).normals) CHECK(is_near(n, {0, 0, 1}));
}

TEST_CASE("cylinders stand on z, open at both ends, their front outside") {
  const Scene scene =
      import_world("Shape \"cylinder\" \"float radius\" 2 \"float zmin\" 1 \"float zmax\" 4");
  const Mesh& mesh = scene.meshes.at(0);
  CHECK(area_of(mesh) == doctest::Approx(2 * pi * 2 * 3).epsilon(0.002));
  const Triangle& t = mesh.triangles.at(0);
  CHECK(dot(Vec3(area_vector(mesh, t)), mesh.positions[t[0]] * Vec3{1, 1, 0}) > 0);
}

TEST_CASE(
    "curves: tubes as wide as the curve from all sides, ribbons on the side of their normals") {
  const std::string straight = "\"point3 P\" [0 0 0 0 0 1 0 0 2 0 0 3] \"float width\" 0.2 ";
  const Scene tube = import_world("Shape \"curve\" \"string type\" \"cylinder\" " + straight);
  // The mean visible area of a round tube is its surface over pi.
  CHECK(area_of(tube.meshes.at(0)) == doctest::Approx(pi * 0.2 * 3).epsilon(1e-4));
  const Mesh& mesh = tube.meshes[0];
  const Triangle& t = mesh.triangles.at(0);
  CHECK(dot(Vec3(area_vector(mesh, t)), mesh.normals.at(t[0])) > 0);
  CHECK(has_warning(import_world("Shape \"curve\" " + straight), "tubes"));
  const Scene ribbon = import_world("Shape \"curve\" \"string type\" \"ribbon\" " + straight +
                                    "\"normal N\" [1 0 0 1 0 0]");
  CHECK(area_of(ribbon.meshes.at(0)) == doctest::Approx(0.6));
  CHECK(is_near(ribbon.meshes[0].normals.at(0), {1, 0, 0}));
  CHECK(area_vector(ribbon.meshes[0], ribbon.meshes[0].triangles.at(0)).x > 0);
  // A B-spline of equal steps runs from the second point to the last but one.
  const Scene spline = import_world(
      "Shape \"curve\" \"string basis\" \"bspline\" \"string type\" \"cylinder\" " + straight);
  CHECK(double(bounds(spline).upper.z) == doctest::Approx(2));
  CHECK(double(bounds(spline).lower.z) == doctest::Approx(1));
}

TEST_CASE("impossible curves and subdivisions are refused") {
  CHECK(reason_of("Shape \"curve\" \"point3 P\" [0 0 0 1 1 1]").find("number of points") !=
        std::string::npos);
  CHECK(
      reason_of("Shape \"curve\" \"integer degree\" 4 \"point3 P\" [0 0 0 1 1 1]").find("degree") !=
      std::string::npos);
  CHECK(reason_of("Shape \"curve\" \"string type\" \"ribbon\" \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 "
                  "0]")
            .find("normal") != std::string::npos);
  CHECK(reason_of("Shape \"loopsubdiv\" \"integer levels\" 13 " + octahedron).find("levels") !=
        std::string::npos);
  // A few bytes must not become gigabytes: 8 triangles times 4^10.
  CHECK(reason_of("Shape \"loopsubdiv\" \"integer levels\" 10 " + octahedron)
            .find("10 levels make 8388608 triangles of 8; at most 2000000") != std::string::npos);
  CHECK(reason_of("Shape \"loopsubdiv\" \"integer levels\" -1 " + octahedron).find("levels") !=
        std::string::npos);
  // A curve whose points all coincide.
  CHECK(import_world("Shape \"curve\" \"point3 P\" [1 1 1 1 1 1 1 1 1 1 1 1]").meshes.size() <= 1);
}

TEST_CASE("mixed materials: two diffuse ones exactly, others by their weight") {
  const std::string two =
      "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" \"rgb reflectance\" [1 0 0]\n"
      "MakeNamedMaterial \"b\" \"string type\" \"diffuse\" \"rgb reflectance\" [0 0 1]\n"
      "MakeNamedMaterial \"c\" \"string type\" \"conductor\"\n";
  const Rgb mixed = material_of(two +
                                "Material \"mix\" \"string materials\" [\"a\" \"b\"] "
                                "\"float amount\" 0.25\n")
                        .base_color.value;
  CHECK(mixed.r == doctest::Approx(0.75));
  CHECK(mixed.b == doctest::Approx(0.25));
  const std::string other = "Material \"mix\" \"string materials\" [\"a\" \"c\"] \"float amount\" ";
  CHECK(material_of(two + other + "0.7\n").kind == MaterialKind::conductor);
  CHECK(material_of(two + other + "0.2\n").kind == MaterialKind::diffuse);
  CHECK(has_warning(import_world(two + other + "0.2\n" + triangle), "larger weight"));
  CHECK(reason_of("Material \"mix\" \"string materials\" [\"a\" \"b\"]").find("\"a\"") !=
        std::string::npos);
  std::string nested = two;
  std::string last = "a";
  for (int i = 0; i < 9; ++i) {
    nested += "MakeNamedMaterial \"m" + std::to_string(i) +
              "\" \"string type\" \"mix\" \"string materials\" [\"" + last + "\" \"b\"]\n";
    last = "m" + std::to_string(i);
  }
  CHECK(reason_of(nested).find("too deeply") != std::string::npos);
}

TEST_CASE("a coated metal has both lobes; translucent paper keeps its reflectance") {
  const Material metal = material_of(
      "Material \"coatedconductor\" \"spectrum conductor.eta\" \"metal-Au-eta\" "
      "\"spectrum conductor.k\" \"metal-Au-k\" \"float conductor.roughness\" 0.3 "
      "\"float interface.roughness\" 0.1 \"float interface.eta\" 1.4\n");
  CHECK(metal.kind == MaterialKind::conductor);
  CHECK(metal.roughness.value == 0.3f);
  CHECK(metal.eta.b > metal.eta.r);  // gold
  CHECK(metal.coat.value == 1);
  CHECK(metal.coat_roughness.value == 0.1f);
  CHECK(metal.coat_ior == 1.4f);
  const Material paper = material_of(
      "Material \"diffusetransmission\" \"rgb reflectance\" [0.4 0.4 0.4] \"float scale\" 0.5\n");
  CHECK(paper.base_color.value.r == doctest::Approx(0.2));
}

TEST_CASE("checkerboards and mixes of plain colours are exact") {
  const Scene scene = import_world(
      "Texture \"c\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [1 0 0] \"rgb tex2\" [0 0 1] "
      "\"float uscale\" 4 \"float vscale\" 2\nTexture \"m\" \"float\" \"mix\" \"float tex1\" 1 "
      "\"float tex2\" 0 \"float amount\" 0.25\nMaterial \"coateddiffuse\" \"texture reflectance\" "
      "\"c\" \"texture roughness\" \"m\"\n" +
      triangle);
  const Material& m = scene.materials.at(scene.meshes.at(0).material);
  CHECK(m.roughness.value == 0.75f);
  for (const double u : {0.05, 0.3, 0.55, 0.8, 1.1})
    for (const double v : {0.1, 0.4, 0.6, 0.9}) {
      // pbrt's v points up, like the mesh's.
      const bool is_first = (int(std::floor(4 * u)) + int(std::floor(2 * v))) % 2 == 0;
      const Rgb c = evaluate(scene.textures, m.base_color, Vec2{float(u), float(v)});
      CHECK(c.r == (is_first ? 1.0f : 0.0f));
      CHECK(c.b == (is_first ? 0.0f : 1.0f));
    }
}

TEST_CASE("alpha of a shape is the share of rays that hit it") {
  const Scene scene =
      import_world("Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"float alpha\" 0.3\n");
  const Material& m = scene.materials.at(scene.meshes.at(0).material);
  CHECK(m.is_alpha_blended);
  CHECK(coverage(scene.textures, m, Vec2{0, 0}) == 0.3f);
}

}  // namespace test_pbrt_shapes
