// Tests of cameras, transforms, orientation and emission of pbrt scenes.
#include <doctest/doctest.h>

#include <string>

#include "base/error.h"
#include "import/mesh_clean.h"
#include "import/pbrt/pbrt.h"
#include "scene_checks.h"
#include "temp_folder.h"

using namespace troffer;

namespace test_pbrt_world {

namespace {

Scene import_world(const std::string& world, const std::string& options = "") {
  const TempFolder folder;
  return import_pbrt(folder.write("scene.pbrt", options + "\nWorldBegin\n" + world));
}

const std::string light = "AreaLightSource \"diffuse\" \"rgb L\" [2 3 4]\n";
const std::string triangle = "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] ";

}  // namespace

TEST_CASE("pbrt's camera looks along +z of the inverse of its transform") {
  const Scene scene =
      import_world("", "LookAt 1 2 3 1 2 10 0 1 0\nCamera \"perspective\" \"float fov\" 60");
  REQUIRE(scene.cameras.size() == 1);
  const Camera& c = scene.cameras[0];
  CHECK(is_near(c.position, {1, 2, 3}));
  CHECK(is_near(c.forward, {0, 0, 1}));
  CHECK(is_near(c.up, {0, 1, 0}));
  CHECK(is_near(c.right, {1, 0, 0}));  // a left-handed frame
  CHECK(c.half_extent == doctest::Approx(std::tan(pi / 6)));
  CHECK_FALSE(c.fov_is_vertical);
  CHECK_FALSE(c.has_screen_window);
  CHECK(c.width == 1280);
  CHECK(c.height == 720);
}

TEST_CASE("a mirror before LookAt mirrors the image") {
  const Scene scene = import_world(
      "",
      "Scale -1 1 1\nLookAt 1 2 3 1 2 10 0 1 0\nCamera \"orthographic\" "
      "\"float screenwindow\" [-1 2 -3 4] \"float lensradius\" .1 \"float focaldistance\" 5");
  const Camera& c = scene.cameras.at(0);
  CHECK(is_near(c.position, {1, 2, 3}));
  CHECK(is_near(c.right, {-1, 0, 0}));
  CHECK(is_near(c.up, {0, 1, 0}));
  CHECK(c.kind == CameraKind::orthographic);
  CHECK(c.half_extent == doctest::Approx(1));
  CHECK(c.has_screen_window);
  CHECK(c.screen_window == std::array<float, 4>{-1, 2, -3, 4});
  CHECK(c.lens_radius == doctest::Approx(0.1));
  CHECK(c.focal_distance == doctest::Approx(5));
  CHECK(scene.warnings.entries().empty());
}

TEST_CASE("the scale of a camera's transform scales lengths in camera space") {
  const Scene scene = import_world("",
                                   "Scale .5 .5 .5\nCamera \"orthographic\" "
                                   "\"float lensradius\" 1 \"float focaldistance\" 3");
  const Camera& c = scene.cameras.at(0);
  CHECK(c.half_extent == doctest::Approx(2));
  CHECK(c.lens_radius == doctest::Approx(2));
  CHECK(c.focal_distance == doctest::Approx(6));
  CHECK(length(c.right) == doctest::Approx(1));
  const Scene stretched = import_world("", "Scale 1 2 1 Camera \"perspective\"");
  CHECK(stretched.warnings.total() == 1);
}

TEST_CASE("frameaspectratio that differs from the film's becomes a screen window") {
  const Scene scene =
      import_world("",
                   "Film \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" 100\n"
                   "Camera \"perspective\" \"float frameaspectratio\" 2");
  CHECK(scene.cameras.at(0).screen_window == std::array<float, 4>{-2, 2, -1, 1});
}

TEST_CASE("pbrt transforms") {
  const auto centre = [](const std::string& transform) {
    return import_world(transform + " Shape \"sphere\"").spheres.at(0).centre;
  };
  CHECK(is_near(centre("Transform [1 0 0 0 0 1 0 0 0 0 1 0 5 6 7 1]"), {5, 6, 7}));
  CHECK(is_near(centre("Translate 1 0 0 ConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 5 6 7 1]"),
                {6, 6, 7}));
  CHECK(is_near(centre("Scale 2 2 2 Translate 1 0 0"), {2, 0, 0}));
  CHECK(is_near(centre("Rotate 90 0 0 1 Translate 1 0 0"), {0, 1, 0}));
  CHECK(is_near(centre("Translate 1 0 0 Identity"), {0, 0, 0}));
  CHECK(is_near(centre("Translate 1 0 0 CoordinateSystem \"a\" Identity Translate 9 9 9 "
                       "CoordSysTransform \"a\""),
                {1, 0, 0}));
  CHECK(is_near(centre("AttributeBegin Translate 1 0 0 AttributeEnd"), {0, 0, 0}));
  CHECK(is_near(centre("TransformBegin Translate 1 0 0 TransformEnd"), {0, 0, 0}));
  CHECK(is_near(centre("ActiveTransform EndTime Translate 1 0 0 ActiveTransform All"), {0, 0, 0}));
  CHECK(is_near(centre("ActiveTransform StartTime Translate 1 0 0"), {1, 0, 0}));
  // Columns of the listed matrix are the images of the axes.
  const Scene turned =
      import_world("Transform [0 1 0 0 -1 0 0 0 0 0 1 0 0 0 0 1] Translate 1 0 0 Shape \"sphere\"");
  CHECK(is_near(turned.spheres.at(0).centre, {0, 1, 0}));
  // The camera's coordinate system is its place in the world.
  const Scene camera = import_world("CoordSysTransform \"camera\" Shape \"sphere\"",
                                    "LookAt 1 2 3 4 5 6 0 1 0 Camera \"perspective\"");
  CHECK(is_near(camera.spheres.at(0).centre, {1, 2, 3}));
}

// The winding decides the front of triangles; ReverseOrientation and mirrors reverse it. Per-vertex
// normals override it; only ReverseOrientation reverses them.
TEST_CASE("the front of meshes") {
  for (const bool is_reversed : {false, true}) {
    for (const bool is_mirrored : {false, true}) {
      for (const int normals : {0, 1, -1}) {
        std::string world = light;
        if (is_reversed) world += "ReverseOrientation\n";
        if (is_mirrored) world += "Scale 1 1 -1\n";
        world += triangle;
        if (normals == 1) world += "\"normal N\" [0 0 1 0 0 1 0 0 1]";
        if (normals == -1) world += "\"normal N\" [0 0 -1 0 0 -1 0 0 -1]";
        const Scene scene = import_world(world);
        CAPTURE(is_reversed);
        CAPTURE(is_mirrored);
        CAPTURE(normals);
        // pbrt: n = cross of world-space edges, here always +z (the mirror leaves z = 0).
        double expected = is_reversed != is_mirrored ? -1 : 1;
        // Normals transform as covectors under the mirror.
        if (normals != 0) expected = normals * (is_mirrored ? -1 : 1) * (is_reversed ? -1 : 1);
        REQUIRE(scene.lights.size() == 1);
        CHECK(front_of(scene, scene.lights[0]).z == doctest::Approx(expected));
        if (normals != 0) CHECK(scene.meshes[0].normals[0].z == doctest::Approx(expected));
        CHECK(scene.lights[0].radiance == Rgb(2, 3, 4));
        CHECK_FALSE(scene.lights[0].is_two_sided);
      }
    }
  }
}

TEST_CASE("the front of a bilinear patch is on the side of du × dv, its order 00 10 01 11") {
  const std::string patch = "Shape \"bilinearmesh\" \"point3 P\" [0 0 0 2 0 0 0 1 0 2 1 0]";
  const Scene scene = import_world(light + patch);
  REQUIRE(scene.lights.size() == 1);
  const Light& e = scene.lights[0];
  CHECK(e.kind == LightKind::polygon);
  CHECK(e.polygon.size() == 4);
  CHECK(front_of(scene, e).z == doctest::Approx(1));
  CHECK(area_of(scene.meshes[0]) == doctest::Approx(2));
  CHECK(scene.meshes[0].uvs.at(1) == Vec2(1, 0));
  const Scene reversed = import_world(light + "ReverseOrientation " + patch);
  CHECK(front_of(reversed, reversed.lights.at(0)).z == doctest::Approx(-1));
}

TEST_CASE("curved bilinear patches are cut into cells with smooth normals") {
  const Scene scene =
      import_world("Shape \"bilinearmesh\" \"point3 P\" [0 0 0  1 0 0  0 1 0  1 1 1]");
  const Mesh& mesh = scene.meshes.at(0);
  CHECK(mesh.triangles.size() == 512);
  CHECK(scene.warnings.entries().empty());
  // z = x y: area = ∫∫ sqrt(1 + x² + y²) = 1.28079 (numerically).
  CHECK(area_of(mesh) == doctest::Approx(1.28079).epsilon(1e-3));
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3 p = mesh.positions[i];
    CHECK(p.z == doctest::Approx(p.x * p.y));
    CHECK(is_near(mesh.normals[i], normalize(Vec3(-p.y, -p.x, 1))));
  }
}

TEST_CASE("spheres and disks stay exact under similarity transforms") {
  const Scene scene = import_world(
      light +
      "Translate 1 2 3 Scale 2 2 2 Rotate 90 1 0 0\nShape \"sphere\" \"float radius\" 3\n"
      "Shape \"disk\" \"float radius\" 3 \"float height\" 1\n"
      "ReverseOrientation Shape \"sphere\" Shape \"disk\"");
  REQUIRE(scene.spheres.size() == 2);
  REQUIRE(scene.disks.size() == 2);
  CHECK(is_near(scene.spheres[0].centre, {1, 2, 3}));
  CHECK(scene.spheres[0].radius == doctest::Approx(6));
  CHECK_FALSE(scene.spheres[0].is_inside_out);
  CHECK(scene.spheres[1].is_inside_out);
  CHECK(scene.disks[0].radius == doctest::Approx(6));
  CHECK(is_near(scene.disks[0].normal, {0, -1, 0}));  // z turned by 90 degrees around x
  CHECK(is_near(scene.disks[0].centre, {1, 0, 3}));
  CHECK(is_near(scene.disks[1].normal, {0, 1, 0}));
  REQUIRE(scene.lights.size() == 4);
  CHECK(scene.lights[0].kind == LightKind::sphere);
  CHECK(scene.lights[1].kind == LightKind::disk);
  CHECK(scene.lights[3].name == "emitter3");
  CHECK(scene.disks[1].light == 3);
  CHECK(scene.lights[3].geometry == 1);
}

TEST_CASE("mirrored quadrics are turned inside out, as in pbrt") {
  const Scene scene = import_world(
      "Scale -1 1 1 Shape \"sphere\" Shape \"disk\" ReverseOrientation "
      "Shape \"sphere\" Shape \"disk\"");
  CHECK(scene.spheres.at(0).is_inside_out);
  CHECK_FALSE(scene.spheres.at(1).is_inside_out);
  CHECK(is_near(scene.disks.at(0).normal, {0, 0, -1}));
  CHECK(is_near(scene.disks.at(1).normal, {0, 0, 1}));
}

TEST_CASE("partial and stretched quadrics become meshes that agree with them") {
  struct Row {
    const char* world;
    double area;
  };
  const double half = 2 * pi, zone = 2 * pi * 0.5;
  for (const Row& row : {Row{"Shape \"sphere\" \"float zmin\" 0", half},
                         Row{"Shape \"sphere\" \"float phimax\" 180", half},
                         Row{"Shape \"sphere\" \"float zmin\" -.25 \"float zmax\" .25", zone},
                         Row{"Shape \"disk\" \"float innerradius\" .5", pi * 0.75},
                         Row{"Shape \"disk\" \"float phimax\" 90", pi / 4},
                         Row{"Scale 2 3 1 Shape \"disk\"", pi * 6},
                         Row{"Scale -1 1 1 Shape \"disk\" \"float phimax\" 90", pi / 4},
                         // Prolate spheroid 1 1 2: closed form.
                         Row{"Scale 1 1 2 Shape \"sphere\"", 21.4784}}) {
    CAPTURE(row.world);
    const Scene scene = import_world(light + row.world);
    REQUIRE(scene.meshes.size() == 1);
    const Mesh& mesh = scene.meshes[0];
    CHECK(area_of(mesh) == doctest::Approx(row.area).epsilon(5e-3));
    CHECK(scene.warnings.entries().empty());
    // Winding and normals agree everywhere.
    for (const Triangle& t : mesh.triangles)
      CHECK(dot(area_vector(mesh, t), Vec3d(mesh.normals[t[0]])) > 0);
    CHECK(scene.lights.size() >= 1);
  }
  // The front is outside; inside if mirrored or reversed.
  const auto outward = [](const std::string& world) {
    const Mesh mesh = import_world(world + " Shape \"sphere\" \"float zmin\" -.5").meshes.at(0);
    return dot(mesh.normals.at(70), mesh.positions.at(70)) > 0;
  };
  CHECK(outward(""));
  CHECK_FALSE(outward("ReverseOrientation"));
  CHECK_FALSE(outward("Scale 1 -1 1"));
  CHECK(outward("Scale 1 -1 1 ReverseOrientation"));
}

TEST_CASE("emission of area lights") {
  const auto radiance = [](const std::string& params) {
    return import_world("AreaLightSource \"diffuse\" " + params + "\n" + triangle)
        .lights.at(0)
        .radiance;
  };
  CHECK(radiance("") == Rgb(1));
  CHECK(radiance("\"rgb L\" [1 2 3] \"float scale\" 2") == Rgb(2, 4, 6));
  const Rgb warm = radiance("\"blackbody L\" 2700 \"float scale\" 10");
  CHECK(luminance(warm) == doctest::Approx(10).epsilon(1e-4));
  CHECK(warm.r > 1.5f * warm.g);
  CHECK(warm.g > 1.5f * warm.b);
  const Rgb day = radiance("\"spectrum L\" \"stdillum-D65\"");
  CHECK(day.r == doctest::Approx(1).epsilon(2e-3));
  CHECK(day.b == doctest::Approx(1).epsilon(2e-3));
  CHECK(luminance(radiance("\"spectrum L\" [400 7 700 7]")) == doctest::Approx(1).epsilon(1e-4));
  // Power: pi × area × radiance per side; the triangle has half a square metre.
  CHECK(radiance("\"float power\" 6").r == doctest::Approx(6 / (pi * 0.5)));
  CHECK(radiance("\"float power\" 6 \"bool twosided\" true").r == doctest::Approx(6 / pi));

  const Scene two = import_world("AreaLightSource \"diffuse\" \"bool twosided\" true " + triangle);
  CHECK(two.lights.at(0).is_two_sided);
  const Scene black = import_world("AreaLightSource \"diffuse\" \"rgb L\" [0 0 0] " + triangle);
  CHECK(black.lights.empty());
  CHECK_THROWS_AS(radiance("\"rgb L\" [1 1 1] \"string filename\" \"a.png\""), InputError);
  CHECK_THROWS_AS(radiance("\"float scale\" -1"), InputError);
  CHECK_THROWS_AS(radiance("\"rgb L\" [1e39 1 1]"), InputError);
  const Scene blinding = import_world(
      "AreaLightSource \"diffuse\" \"rgb L\" [1e38 1 1] \"float scale\" 1e3 " + triangle);
  CHECK(blinding.lights.empty());
  CHECK(blinding.warnings.total() == 1);
}

TEST_CASE("emitting shapes are numbered in order, whatever happens to them") {
  const Scene scene = import_world(
      triangle + light + "Shape \"paraboloid\"\n" + triangle +
      "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 2 0 0]\nShape \"sphere\"\n"
      "AttributeBegin Material \"interface\" Shape \"sphere\" AttributeEnd Shape \"disk\"");
  REQUIRE(scene.lights.size() == 3);
  CHECK(scene.lights[0].name == "emitter1");
  CHECK(scene.lights[1].name == "emitter3");
  CHECK(scene.lights[2].name == "emitter5");
  CHECK(scene.meshes.at(0).lights.empty());
}

TEST_CASE("instances are placed by both transforms and do not emit") {
  const Scene scene = import_world("Translate 0 0 1\nObjectBegin \"o\"\nTranslate 1 0 0\n" +
                                   triangle + "Shape \"sphere\"\n" + light +
                                   "Shape \"disk\"\nObjectEnd\n"
                                   "AttributeBegin Scale 2 2 2 ObjectInstance \"o\" AttributeEnd\n"
                                   "AttributeBegin Scale 1 1 3 ObjectInstance \"o\" AttributeEnd");
  CHECK(scene.lights.empty());
  CHECK(scene.warnings.total() == 1);
  REQUIRE(scene.meshes.size() == 3);  // two triangles and a stretched sphere
  REQUIRE(scene.spheres.size() == 1);
  CHECK(scene.disks.size() == 2);
  // (Translate 0 0 1)(Scale 2)(Translate 0 0 1)(Translate 1 0 0)
  CHECK(is_near(scene.spheres[0].centre, {2, 0, 3}));
  CHECK(scene.spheres[0].radius == doctest::Approx(2));
  CHECK(is_near(scene.meshes[0].positions[0], {2, 0, 3}));
}

TEST_CASE("too many nested instances are refused before memory runs out") {
  std::string world = "ObjectBegin \"o\"\n";
  for (int i = 0; i < 2000; ++i) world += "Shape \"sphere\"\n";
  world += "ObjectEnd\n";
  std::string instances;
  for (int i = 0; i < 2000; ++i) instances += "ObjectInstance \"o\"\n";
  CHECK_THROWS_AS(import_world(world + instances), InputError);
}

TEST_CASE("odd geometry is left out with counted warnings") {
  const Scene scene = import_world(
      "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 nan 0 0 2 0 0]\n"
      "\"integer indices\" [0 1 2  0 1 3  0 1 4  0 0 1]\n"
      "Shape \"sphere\" \"float radius\" 0\nShape \"sphere\" \"float alpha\" 0\n"
      "AttributeBegin Scale 0 0 0 Shape \"sphere\" AttributeEnd");
  CHECK(triangle_count(scene) == 1);
  CHECK(scene.spheres.empty());
  CHECK(scene.warnings.total() >= 5);
  for (const Mesh& mesh : scene.meshes)
    for (const Vec3& p : mesh.positions) CHECK(is_finite(p));
}

TEST_CASE("kj92room has four sources that face into the room") {
  const std::string folder = std::string(TROFFER_SOURCE_DIR) + "/scenes/kj92room/";
  for (const char* name : {"kj92room_direct.pbrt", "kj92room_full.pbrt"}) {
    const Scene scene = import_pbrt(folder + name);
    CHECK(scene.warnings.entries().empty());
    REQUIRE(scene.lights.size() == 4);
    const Vec3 fronts[] = {{0, 0, -1}, {1, 0, 0}, {-1, 0, 0}, {-1, 0, 0}};
    for (size_t i = 0; i < 4; ++i) {
      const Light& e = scene.lights[i];
      CHECK(e.name == "emitter" + std::to_string(i));
      CHECK(e.kind == LightKind::polygon);
      CHECK(e.polygon.size() == 4);
      CHECK(is_near(front_of(scene, e), fronts[i]));
      CHECK(e.radiance == Rgb(i < 2 ? 4.0f : 600.0f));
    }
    REQUIRE(scene.cameras.size() == 1);
    const Camera& c = scene.cameras[0];
    CHECK(is_near(c.position, {2, 0.2f, 1.75f}));
    CHECK(is_near(c.right, {1, 0, 0}));  // as in the right-handed formats
    CHECK(c.width == 256);
    CHECK(triangle_count(scene) == 92);
  }
}

TEST_CASE("modern-hall has thirteen sources that face into the hall") {
  const std::string folder = std::string(TROFFER_SOURCE_DIR) + "/scenes/modern-hall/";
  const Vec3 fronts[] = {{0, 0, 1},  {0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1},
                         {0, 0, 1},  {0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, -0.307563f, -0.951528f},
                         {0, 0, -1}, {1, 0, 0}, {0, 1, 0}};
  for (const char* name : {"modern-hall.pbrt", "modern-hall-diffuse.pbrt"}) {
    const Scene scene = import_pbrt(folder + name);
    REQUIRE(scene.lights.size() == 13);
    CHECK(scene.disks.size() == 5);
    for (size_t i = 0; i < 13; ++i) {
      CAPTURE(i);
      CHECK(scene.lights[i].kind == (i < 5 ? LightKind::disk : LightKind::polygon));
      CHECK(is_near(front_of(scene, scene.lights[i]), fronts[i], 1e-4f));
    }
    CHECK(triangle_count(scene) > 25000);
    CHECK(scene.warnings.entries().size() <= 3);
  }
  const Scene scene = import_pbrt(folder + "modern-hall.pbrt");
  CHECK(scene.textures.size() == 3);
  for (const Texture& t : scene.textures) {
    CHECK(t.kind == TextureKind::image);
    CHECK(t.uv_scale.y == -1);
  }
}

TEST_CASE("rgb in other colour spaces becomes linear sRGB by their primaries") {
  const auto scene_of = [](const std::string& space, const std::string& rgb) {
    return import_world("AttributeBegin ColorSpace \"" + space +
                        "\" Material \"diffuse\" \"rgb reflectance\" [" + rgb + "]\n" +
                        "AreaLightSource \"diffuse\" \"rgb L\" [" + rgb + "]\n" + triangle +
                        " AttributeEnd LightSource \"point\" \"rgb I\" [2 3 4]");
  };
  const auto near = [](const Rgb& a, const Rgb& b) {
    return is_near({a.r, a.g, a.b}, {b.r, b.g, b.b}, 1e-3f);
  };
  struct Row {
    const char* name;
    Rgb reflectance;
  };
  // Values by published matrices: ITU-R BT.2407, Display P3's with the same primaries, the
  // Academy's.
  for (const Row& row :
       {Row{"srgb", {0.3f, 0.5f, 0.2f}}, Row{"rec2020", {0.190f, 0.527f, 0.168f}},
        Row{"DCI-P3", {0.255f, 0.508f, 0.174f}}, Row{"aces2065-1", {0.112f, 0.584f, 0.153f}}}) {
    CAPTURE(row.name);
    const Scene scene = scene_of(row.name, ".3 .5 .2");
    CHECK(scene.warnings.entries().empty());
    REQUIRE(scene.lights.size() == 2);
    const Rgb color = scene.materials.at(scene.meshes.at(0).material).base_color.value;
    CHECK(near(color, row.reflectance));
    for (const Light& l : scene.lights)  // the space ends with its block
      if (l.kind == LightKind::point) CHECK(near(l.radiance, {2, 3, 4}));
    // A perfectly white surface is white in every space; a white light has the space's white point.
    const Scene white = scene_of(row.name, "1 1 1");
    CHECK(white.warnings.entries().empty());
    CHECK(white.materials.at(white.meshes.at(0).material).base_color.value == Rgb(1));
    const Rgb shining = white.lights.at(0).radiance;
    CHECK(luminance(shining) == doctest::Approx(1).epsilon(1e-3));
    CHECK((shining.r > 1.05f * shining.b) == (std::string(row.name) == "aces2065-1"));
  }
  const Scene by_attribute = import_world(
      "ColorSpace \"rec2020\" Attribute \"material\" "
      "\"rgb reflectance\" [.3 .5 .2]\nColorSpace \"srgb\" "
      "Material \"diffuse\" " +
      triangle);
  CHECK(near(by_attribute.materials.at(by_attribute.meshes.at(0).material).base_color.value,
             {0.3f, 0.5f, 0.2f}) == false);
}

}  // namespace test_pbrt_world
