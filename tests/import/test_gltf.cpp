// Tests of whole glTF documents: nodes, transforms, cameras, errors, and the scenes of the
// repository.
#include <doctest/doctest.h>

#include <cmath>

#include "import/gltf_builder.h"

using namespace troffer;

namespace test_gltf {

namespace {

const std::string plain_material = "'materials':[{}]";
const std::string glowing_material =
    "'materials':[{'emissiveFactor':[1,0.5,0.25],"
    "'extensions':{'KHR_materials_emissive_strength':{'emissiveStrength':8}}}]";

void check_near(const Vec3& a, const Vec3& b, float tolerance = 1e-5f) {
  CAPTURE(a.x);
  CAPTURE(a.y);
  CAPTURE(a.z);
  CHECK(length(a - b) <= tolerance);
}

Vec3 geometric_normal(const Mesh& mesh, size_t triangle) {
  const Triangle& t = mesh.triangles[triangle];
  const Vec3 a = mesh.positions[t[0]];
  return normalize(cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a));
}

Vec3 polygon_normal(const std::vector<Vec3>& p) {
  return normalize(cross(p[1] - p[0], p[2] - p[1]));
}

Scene scene_of_repository(const std::string& name) {
  return import_gltf(std::string(TROFFER_SOURCE_DIR) + "/scenes/" + name);
}

}  // namespace

TEST_CASE("a square is read with normals, texture coordinates and name") {
  const Scene scene = import_text(square_scene("[{'mesh':0,'name':'wall'}]", plain_material));
  REQUIRE(scene.meshes.size() == 1);
  const Mesh& mesh = scene.meshes[0];
  CHECK(mesh.name == "wall");
  CHECK(mesh.positions.size() == 4);
  CHECK(mesh.triangles.size() == 2);
  CHECK(mesh.uvs.size() == 4);
  CHECK(mesh.uvs[0] == Vec2{0, 1});
  CHECK(mesh.normals[2] == Vec3{0, 0, 1});
  check_near(geometric_normal(mesh, 0), {0, 0, 1});
  CHECK(scene.is_photometric);
  CHECK(scene.lights.empty());
  CHECK(scene.warnings.entries().empty());
}

TEST_CASE("node transforms compose: translation, rotation, scale, matrix, hierarchy") {
  // The child doubles the size; the parent turns +x to +y around z and then lifts by 3.
  const Scene scene = import_text(
      square_scene("[{'children':[1],'translation':[0,0,3],'rotation':[0,0,0.70710678,0.70710678]},"
                   "{'mesh':0,'matrix':[2,0,0,0, 0,2,0,0, 0,0,2,0, 1,0,0,1]}]",
                   plain_material));
  REQUIRE(scene.meshes.size() == 1);
  check_near(scene.meshes[0].positions[0], {0, 1, 3});
  check_near(scene.meshes[0].positions[1], {0, 3, 3});
  check_near(scene.meshes[0].positions[3], {-2, 1, 3});
  check_near(scene.meshes[0].normals[0], {0, 0, 1});
}

TEST_CASE("normals under shear and uneven scale stay perpendicular to the surface") {
  const Scene scene = import_text(
      square_scene("[{'mesh':0,'matrix':[1,0,2,0, 0,3,1,0, 0,0,0.5,0, 0,0,0,1]}]", plain_material));
  const Mesh& mesh = scene.meshes[0];
  for (size_t t = 0; t < 2; ++t) check_near(mesh.normals[0], geometric_normal(mesh, t));
}

TEST_CASE("a mirrored node keeps its front: winding, normals and emission agree") {
  // z -> -z turns the front to -z; x -> -x must leave it at +z.
  for (const bool is_x : {true, false}) {
    const Scene scene = import_text(
        square_scene(is_x ? "[{'mesh':0,'scale':[-1,1,1]}]" : "[{'mesh':0,'scale':[1,1,-1]}]",
                     glowing_material));
    const Vec3 front{0, 0, is_x ? 1.0f : -1.0f};
    const Mesh& mesh = scene.meshes[0];
    check_near(geometric_normal(mesh, 0), front);
    check_near(geometric_normal(mesh, 1), front);
    check_near(mesh.normals[0], front);
    REQUIRE(scene.lights.size() == 1);
    check_near(polygon_normal(scene.lights[0].polygon), front);
  }
}

TEST_CASE("emitters carry radiance, strength, side and names") {
  const Scene scene = import_text(square_scene(
      "[{'mesh':0},{'mesh':0,'name':'lamp','translation':[0,0,5]},{'mesh':0}]", glowing_material));
  REQUIRE(scene.lights.size() == 3);
  CHECK(scene.lights[0].name == "emitter0");
  CHECK(scene.lights[1].name == "lamp");
  CHECK(scene.lights[2].name == "emitter2");
  const Light& lamp = scene.lights[1];
  CHECK(lamp.kind == LightKind::polygon);
  CHECK(lamp.radiance == Rgb{8, 4, 2});
  CHECK_FALSE(lamp.is_two_sided);
  CHECK(lamp.polygon.size() == 4);
  CHECK(lamp.triangles == std::vector<uint32_t>{0, 1});
  CHECK(scene.meshes[lamp.geometry].lights == std::vector<int32_t>{1, 1});
  const Scene two_sided = import_text(
      square_scene("[{'mesh':0}]", "'materials':[{'emissiveFactor':[1,1,1],'doubleSided':true}]"));
  CHECK(two_sided.lights[0].is_two_sided);
}

TEST_CASE("only the default scene is shown; without scenes, all roots are") {
  const std::string nodes = "[{'mesh':0},{'mesh':0,'translation':[0,0,9]}]";
  Scene scene = import_text(
      square_scene(nodes, plain_material + ",'scene':1,'scenes':[{'nodes':[0]},{'nodes':[1]}]"));
  REQUIRE(scene.meshes.size() == 1);
  CHECK(scene.meshes[0].positions[0].z == 9);
  CHECK(import_text(square_scene(nodes, plain_material)).meshes.size() == 2);
  scene = import_text(square_scene(nodes, plain_material + ",'scenes':[{}]"));
  CHECK(scene.meshes.empty());
  CHECK(has_warning(scene, "no visible triangles"));
}

TEST_CASE("cameras: vertical field of view, aspect, orthographic size, names, node transforms") {
  const Scene scene = import_text(gltf_text(
      "'cameras':[{'type':'perspective','perspective':{'yfov':1.0,'aspectRatio':1.5,"
      "'znear':0.1}},{'type':'orthographic','name':'plan','orthographic':{'xmag':4,'ymag':2,"
      "'znear':0,'zfar':10}}],'nodes':[{'camera':0,'translation':[1,2,3]},{'camera':1,"
      "'rotation':[-0.70710678,0,0,0.70710678],'scale':[7,7,7]},{'camera':0,'name':'door'}]"));
  REQUIRE(scene.cameras.size() == 3);
  const Camera& first = scene.cameras[0];
  CHECK(first.name == "camera0");
  CHECK(first.half_extent == doctest::Approx(std::tan(0.5)));
  CHECK(first.fov_is_vertical);
  CHECK(first.aspect == 1.5f);
  check_near(first.position, {1, 2, 3});
  check_near(first.forward, {0, 0, -1});
  check_near(first.up, {0, 1, 0});
  check_near(first.right, {1, 0, 0});
  const Camera& plan = scene.cameras[1];
  CHECK(plan.name == "plan");
  CHECK(plan.kind == CameraKind::orthographic);
  CHECK(plan.half_extent == 2);
  CHECK(plan.aspect == 2);
  check_near(plan.forward, {0, -1, 0});  // -90 degrees around x: looks down
  check_near(plan.up, {0, 0, -1});
  check_near(plan.right, {1, 0, 0});
  CHECK(scene.cameras[2].name == "door");
  const Scene one = import_text(gltf_text(
      "'cameras':[{'type':'perspective','perspective':{'yfov':-1,'znear':0.1}},{'type':"
      "'perspective','perspective':{'yfov':1,'znear':0.1}}],'nodes':[{'camera':0,'name':'bad'},"
      "{'camera':1,'name':'good'}]"));
  REQUIRE(one.cameras.size() == 1);
  CHECK(one.cameras[0].name == "good");
  CHECK(has_warning(one, "camera 'bad' cannot be used and is left out"));
}

TEST_CASE("wrong hierarchies are refused") {
  CHECK(error_of(gltf_text("'nodes':[{'children':[1]},{'children':[0]}]"))
            .reason()
            .find("ancestor") != std::string::npos);
  CHECK(error_of(gltf_text("'nodes':[{'children':[0]}]")).reason().find("own child") !=
        std::string::npos);
  CHECK(error_of(gltf_text("'nodes':[{'children':[2]},{'children':[2]},{}]"))
            .reason()
            .find("already is a child") != std::string::npos);
  CHECK(error_of(gltf_text("'nodes':[{'children':[7]}]")).reason().find("there are only 1") !=
        std::string::npos);
}

TEST_CASE("a hierarchy of any depth is read without recursion") {
  std::string nodes;
  const int depth = 100'000;
  for (int i = 0; i + 1 < depth; ++i) nodes += "{'children':[" + std::to_string(i + 1) + "]},";
  const Scene scene = import_text(square_scene("[" + nodes + "{'mesh':0}]", plain_material));
  CHECK(scene.meshes.size() == 1);
}

TEST_CASE("unknown extensions are warnings, stronger ones if a file requires them") {
  const Scene scene = import_text(square_scene(
      "[{'mesh':0}]", plain_material + ",'extensionsUsed':['ABC_clouds','KHR_materials_ior',"
                                       "'ABC_rain'],'extensionsRequired':['ABC_rain']"));
  CHECK(scene.meshes.size() == 1);
  CHECK(has_warning(scene, "'ABC_clouds' is not supported and ignored"));
  CHECK(has_warning(scene, "'ABC_rain' is not supported, although the file requires it"));
  CHECK_FALSE(has_warning(scene, "'ABC_rain' is not supported and"));
  CHECK_FALSE(has_warning(scene, "KHR_materials_ior"));
}

TEST_CASE("a listed node is shown once, where its parents place it") {
  const std::string nodes =
      "[{'translation':[0,0,5],'children':[1]},{'mesh':0,'translation':[0,0,2]}]";
  const auto heights = [&](const std::string& listed) {
    const Scene scene =
        import_text(square_scene(nodes, plain_material + ",'scenes':[{'nodes':[" + listed + "]}]"));
    REQUIRE(scene.meshes.size() == 1);
    CHECK(scene.meshes[0].positions[0].z == 7);
    return scene;
  };
  CHECK(heights("0").warnings.total() == 0);
  CHECK(has_warning(heights("1"), "is not a root"));
  CHECK(has_warning(heights("1,0"), "is not a root"));
  CHECK(has_warning(heights("0,0"), "listed twice"));
}

TEST_CASE("errors name line and column of the offending value") {
  InputError e =
      error_of("{\n  \"asset\": {\"version\": \"2.0\"},\n  \"nodes\": [{\"mesh\": 3}]\n}");
  CHECK(e.line() == 3);
  CHECK(e.column() == 22);
  e = error_of("{\n  \"asset\": {\"version\": 2},\n}");
  CHECK(e.line() == 3);  // a trailing comma
  e = error_of("{\n  \"asset\": {\"version\": 2}}");
  CHECK(e.line() == 2);
  CHECK(e.column() == 24);
  e = error_of("{\n \"nodes\": [1e999] }");
  CHECK(e.line() == 2);
}

TEST_CASE("values of a wrong type are always errors") {
  for (const std::string value : {"'x'", "-1", "1.5", "1e300", "null", "[]", "{}", "true",
                                  "18446744073709551615", "99999999999999999999999"}) {
    CAPTURE(value);
    error_of(gltf_text("'nodes':[{'mesh':" + value + "}]"));
    error_of(gltf_text("'accessors':[{'componentType':5126,'type':'VEC3','count':" + value + "}]"));
    error_of(gltf_text("'bufferViews':[{'buffer':0,'byteLength':" + value + "}]"));
    error_of(gltf_text("'scene':" + value));
  }
  for (const char* const name : {"nodes", "meshes", "accessors", "buffers", "materials", "images",
                                 "textures", "samplers", "cameras", "scenes", "skins"})
    for (const std::string value : {"5", "[5]", "['x']", "[null]"}) {
      CAPTURE(name);
      error_of(gltf_text(std::string("'") + name + "':" + value));
    }
}

TEST_CASE("kj92room: four polygon sources with the normals and radiances of its description") {
  const Scene scene = scene_of_repository("kj92room/kj92room.gltf");
  REQUIRE(scene.lights.size() == 4);
  const std::array<Vec3, 4> normals{Vec3{0, 0, -1}, Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{-1, 0, 0}};
  const std::array<float, 4> radiances{4, 4, 600, 600};
  for (size_t i = 0; i < 4; ++i) {
    const Light& e = scene.lights[i];
    CHECK(e.name == "emitter" + std::to_string(i));
    CHECK(e.kind == LightKind::polygon);
    CHECK(e.radiance == Rgb{radiances[i]});
    REQUIRE(e.polygon.size() == 4);
    check_near(polygon_normal(e.polygon), normals[i]);
  }
  CHECK(scene.cameras.size() == 1);
  CHECK(scene.warnings.entries().empty());
  CHECK(triangle_count(scene) == 92);
  for (const Material& m : scene.materials) CHECK(m.kind == MaterialKind::diffuse);
}

TEST_CASE("modern-hall: thirteen sources, three textures, glass") {
  const Scene scene = scene_of_repository("modern-hall/modern-hall.gltf");
  CHECK(scene.lights.size() == 13);
  CHECK(scene.textures.size() == 3);
  for (const Texture& t : scene.textures) CHECK(t.kind == TextureKind::image);
  CHECK(scene.materials.size() == 12);
  CHECK(triangle_count(scene) > 28'000);
  size_t glass = 0;
  for (const Material& m : scene.materials) glass += m.transmission.value == 1 && !m.is_thin;
  CHECK(glass == 1);
  // triangles without area, and six meshes wound against their normals
  CHECK(scene.warnings.entries().size() <= 2);
}

}  // namespace test_gltf
