// Scenes written in each format and read again are equal, except for properties that the format
// cannot hold.
#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "base/error.h"
#include "base/units.h"
#include "export/export_scene.h"
#include "import/import.h"
#include "import/temp_folder.h"
#include "support/instanced_scenes.h"

using namespace troffer;

namespace test_round_trip {

namespace {

const std::string world = R"(
LookAt 1 -6 2  0 0 1.5  0 0 1
Film "rgb" "integer xresolution" 90 "integer yresolution" 60
Camera "perspective" "float fov" 50
WorldBegin
LightSource "point" "rgb I" [3 2 1] "point3 from" [1 -1 2.5]
LightSource "spot" "rgb I" [20 20 30] "point3 from" [-1 -1 2.8] "point3 to" [-1 0 0] "float coneangle" 30
LightSource "distant" "rgb L" [.3 .3 .2] "point3 to" [.5 1 -1]
Material "diffuse" "rgb reflectance" [.6 .5 .4]
Shape "trianglemesh" "point3 P" [-3 -3 0  3 -3 0  3 3 0  -3 3 0] "integer indices" [0 1 2 0 2 3]
AttributeBegin
AreaLightSource "diffuse" "rgb L" [8 6 4]
Translate 1.5 1 2
Shape "sphere" "float radius" .3
AttributeEnd
AttributeBegin
AreaLightSource "diffuse" "rgb L" [4 6 8] "bool twosided" true
Translate -1.5 1 2
Rotate 60 1 0 0
Shape "disk" "float radius" .5
AttributeEnd
AttributeBegin
AreaLightSource "diffuse" "rgb L" [9 9 9]
ReverseOrientation
Shape "trianglemesh" "point3 P" [-.5 0 3.5  .5 0 3.5  .5 1 3.5  -.5 1 3.5] "integer indices" [0 1 2 0 2 3]
AttributeEnd
ObjectBegin "o"
Material "conductor" "rgb reflectance" [.6 .1 .1] "float roughness" .25
Shape "sphere" "float radius" .4
ObjectEnd
ObjectInstance "o"
Translate 1 -.5 0
ObjectInstance "o"
)";

double area_of(const Scene& scene, const Light& e) {
  if (e.kind == LightKind::sphere) return 4 * pi * sqr(double(scene.spheres[e.geometry].radius));
  if (e.kind == LightKind::disk) return pi * sqr(double(scene.disks[e.geometry].radius));
  double sum = 0;
  const Mesh& m = scene.meshes[e.geometry];
  for (const uint32_t i : e.triangles) {
    const Triangle& t = m.triangles[i];
    const Vec3d p(m.positions[t[0]]);
    sum += length(cross(Vec3d(m.positions[t[1]]) - p, Vec3d(m.positions[t[2]]) - p)) / 2;
  }
  return sum;
}

// Returns the sum of radiance times area over emitting surfaces in W/sr, per channel. Two-sided
// ones count twice.
Rgb total_emission(const Scene& scene) {
  Rgb sum;
  for (const Light& e : scene.lights)
    if (has_surface(e.kind))
      sum += e.radiance * float(area_of(scene, e) * (e.is_two_sided ? 2 : 1) /
                                (scene.is_photometric ? luminous_efficacy : 1));
  return sum;
}

void check_near(Rgb a, Rgb b, double tolerance) {
  for (size_t c = 0; c < 3; ++c)
    CHECK(double(a[c]) == doctest::Approx(double(b[c])).epsilon(tolerance));
}

void check_near(const Vec3& a, const Vec3& b, float tolerance = 1e-5f) {
  CHECK(length(a - b) <= tolerance);
}

std::map<LightKind, Light> punctual(const Scene& scene) {
  std::map<LightKind, Light> out;
  for (const Light& e : scene.lights)
    if (!has_surface(e.kind)) out[e.kind] = e;
  return out;
}

std::string text_of(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

size_t count_of(const std::string& text, const std::string& part) {
  size_t n = 0;
  for (size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++n;
  return n;
}

bool has_warning(const std::vector<Warning>& warnings, const std::string& part) {
  for (const Warning& w : warnings)
    if (w.text.find(part) != std::string::npos) return true;
  return false;
}

Texture two_texels(uint8_t first, uint8_t second) {
  Texture t;
  t.kind = TextureKind::image;
  t.width = 2;
  t.height = t.channels = 1;
  t.texels8 = {first, second};
  t.is_srgb = false;
  return t;
}

}  // namespace

TEST_CASE("lights, cameras and materials survive in every format") {
  const TempFolder folder;
  const Scene scene = import_scene(folder.write("in.pbrt", world));
  for (const std::string name : {"out.pbrt", "out.gltf", "out.glb"}) {
    CAPTURE(name);
    // y is declared up, so that positions stay the same.
    const std::vector<Warning> lost =
        export_scene(scene, folder.path(name), nullptr, Vec3{0, 1, 0});
    CHECK(has_warning(lost, "spheres and disks") == (name != "out.pbrt"));
    const Scene back = import_scene(folder.path(name));
    CHECK(back.warnings.entries().empty());
    const double unit = back.is_photometric ? luminous_efficacy : 1;
    check_near(total_emission(back), total_emission(scene), 1e-4);
    CHECK(back.lights.size() == scene.lights.size());
    const auto was = punctual(scene), is = punctual(back);
    REQUIRE(is.size() == 3);
    for (const auto& [kind, e] : was) {
      const Light& f = is.at(kind);
      check_near(f.radiance, e.radiance * float(unit), 1e-5);
      if (kind != LightKind::distant) check_near(f.position, e.position);
      if (kind != LightKind::point) check_near(f.direction, e.direction);
      if (kind == LightKind::spot) CHECK(f.cos_outer == doctest::Approx(double(e.cos_outer)));
    }
    const Camera &c = scene.cameras.at(0), &d = back.cameras.at(0);
    check_near(d.position, c.position);
    check_near(d.forward, c.forward);
    check_near(d.right, c.right);
    check_near(d.up, c.up);
    CHECK(d.aspect == doctest::Approx(1.5));
    CHECK(d.half_extent == doctest::Approx(double(c.half_extent)));
    const Boxd before = bounds_in_file(scene), after = bounds_in_file(back);
    check_near(Vec3(after.lower), Vec3(before.lower), 1e-3f);
    check_near(Vec3(after.upper), Vec3(before.upper), 1e-3f);
  }
}

TEST_CASE("a pbrt file that is written again is read as exactly the same scene") {
  const TempFolder folder;
  const Scene scene = import_scene(folder.write("in.pbrt", world));
  CHECK(export_scene(scene, folder.path("out.pbrt")).empty());
  const Scene back = import_scene(folder.path("out.pbrt"));
  REQUIRE(back.spheres.size() == scene.spheres.size());
  for (size_t i = 0; i < back.spheres.size(); ++i) {
    CHECK(back.spheres[i].centre == scene.spheres[i].centre);
    CHECK(back.spheres[i].radius == scene.spheres[i].radius);
  }
  CHECK(triangle_count(back) == triangle_count(scene));
  const Material& metal = back.materials[back.spheres[1].material];
  CHECK(metal.kind == MaterialKind::conductor);
  CHECK(metal.base_color.value == Rgb{0.6f, 0.1f, 0.1f});
  CHECK(metal.roughness.value == 0.5f);  // the GGX width itself
}

TEST_CASE("a portal keeps its place, also in scenes far from the origin") {
  const TempFolder folder;
  const std::string text =
      "WorldBegin\nTranslate 40000 0 0\n"
      "LightSource \"infinite\" \"point3 portal\" [40001 0 0 40001 0 2 40001 3 2 40001 3 0]\n"
      "Shape \"sphere\" \"float radius\" 2\n";
  const Scene scene = import_scene(folder.write("in.pbrt", text));
  CHECK(export_scene(scene, folder.path("out.pbrt")).empty());
  const Scene back = import_scene(folder.path("out.pbrt"));
  REQUIRE(back.lights.size() == 1);
  REQUIRE(back.lights[0].portal.size() == 4);
  for (size_t i = 0; i < 4; ++i) CHECK(back.lights[0].portal[i] == scene.lights[0].portal[i]);
  const Vec3d corner = Vec3d(back.lights[0].portal[2]) + back.origin;
  CHECK(length(corner - Vec3d{40001, 3, 2}) < 1e-3);
}

TEST_CASE("textures, masks and scenes far from the origin survive a round trip") {
  const TempFolder folder;
  std::string pfm = "PF\n2 1\n-1.0\n";
  for (const float v : {0.25f, 0.5f, 0.75f, 1.0f, 0.5f, 0.0f})
    pfm.append(reinterpret_cast<const char*>(&v), sizeof v);
  folder.write("t.pfm", pfm);
  const Scene scene = import_scene(folder.write(
      "in.pbrt",
      "WorldBegin\nTexture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"t.pfm\" \"string "
      "filter\" \"point\" \"float uscale\" 2 \"float vdelta\" .25\nTexture \"a\" \"float\" "
      "\"imagemap\" \"string filename\" \"t.pfm\" \"string filter\" \"point\"\nMaterial "
      "\"diffuse\" "
      "\"texture reflectance\" \"t\"\nTranslate 5000 7000 3\nShape \"trianglemesh\" \"point3 P\" "
      "[0 0 "
      "0 1 0 0 0 1 0] \"point2 uv\" [0 0 1 0 0 1] \"texture alpha\" \"a\""));
  REQUIRE(scene.origin != Vec3d{});
  for (const std::string name : {"out.pbrt", "out.glb"}) {
    CAPTURE(name);
    export_scene(scene, folder.path(name), nullptr, Vec3{0, 1, 0});
    const Scene back = import_scene(folder.path(name));
    CHECK(back.origin == scene.origin);
    REQUIRE(back.meshes.size() == 1);
    CHECK(back.meshes[0].positions == scene.meshes[0].positions);
    const Material &m = scene.materials[scene.meshes[0].material],
                   &n = back.materials[back.meshes[0].material];
    REQUIRE(n.is_alpha_masked);
    for (const Vec2 uv : {Vec2{0.1f, 0.5f}, Vec2{0.3f, 0.5f}, Vec2{0.6f, 0.5f}, Vec2{0.9f, 0.5f}}) {
      CHECK(is_cut_out(back.textures, n, uv) == is_cut_out(scene.textures, m, uv));
      // glTF stores colour and alpha in one image, so the colour is resampled.
      if (name == "out.pbrt")
        check_near(evaluate(back.textures, n.base_color, uv),
                   evaluate(scene.textures, m.base_color, uv), 1e-4);
    }
  }
}

TEST_CASE(
    "two sets of texture coordinates, sheen and anisotropy survive in glTF; other formats warn") {
  const TempFolder folder;
  Scene scene;
  const Texture t = two_texels(0, 255);
  scene.textures = {t, t};
  scene.textures[1].mapping = TextureMapping::second_uv;
  Material m;
  m.kind = MaterialKind::metallic_roughness;
  m.base_color = {Rgb{1}, 0};
  m.roughness = {1, 1, 1};
  m.sheen_color.value = {0.5f, 0.25f, 0};
  m.sheen_roughness.value = 0.75f;
  m.anisotropy.value = 0.5f;
  m.anisotropy_rotation_rad = 0.25f;
  scene.materials = {m};
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.uvs = {{0, 0}, {1, 0}, {0, 1}};
  mesh.uvs_2 = {{0, 0.5f}, {0.5f, 0}, {1, 1}};
  mesh.triangles = {{0, 1, 2}};
  scene.meshes = {mesh};
  export_scene(scene, folder.path("out.glb"));
  const Scene back = import_scene(folder.path("out.glb"));
  CHECK(back.meshes[0].uvs == mesh.uvs);
  CHECK(back.meshes[0].uvs_2 == mesh.uvs_2);
  const Material& n = back.materials[0];
  const TexturePlace place(Vec2{0.25f, 0.5f}, Vec2{0.75f, 0.5f});
  CHECK(evaluate(back.textures, n.base_color, place).g == 0);
  CHECK(evaluate(back.textures, n.roughness, place) == doctest::Approx(1));
  check_near(n.sheen_color.value, m.sheen_color.value, 1e-6);
  CHECK(n.sheen_roughness.value == 0.75f);
  CHECK(n.anisotropy.value == 0.5f);
  CHECK(n.anisotropy_rotation_rad == 0.25f);
  const std::vector<Warning> lost = export_scene(scene, folder.path("out.pbrt"));
  for (const char* what : {"second set", "sheen", "grain"}) {
    CAPTURE(what);
    CHECK(has_warning(lost, what));
  }
}

TEST_CASE("clear coats and thin films survive in formats that have them") {
  const TempFolder folder;
  Scene scene;
  const Texture t = two_texels(51, 255);
  scene.textures = {t};
  Material shiny;
  shiny.kind = MaterialKind::metallic_roughness;
  shiny.metallic.value = 1;
  shiny.coat = {1, 0, 0};
  shiny.coat_roughness.value = 0.25f;
  shiny.roughness.value = 0.5f;
  shiny.roughness_meaning = RoughnessMeaning::alpha_is_square;
  shiny.has_coat_normal = true;
  shiny.iridescence.value = 0.5f;
  shiny.film_thickness = {1, 0, 0};
  shiny.film_ior = 1.4f;
  shiny.film_thinnest_nm = 200;
  shiny.film_thickest_nm = 700;
  Material varnished;
  varnished.kind = MaterialKind::conductor;
  varnished.roughness.value = 0.2f;
  varnished.coat.value = 1;
  varnished.coat_roughness.value = 0.05f;
  varnished.coat_ior = 1.6f;
  Material glazed;
  glazed.kind = MaterialKind::dielectric;
  glazed.coat.value = 0.5f;
  glazed.coat_roughness.value = 0.04f;
  Material tinted;
  tinted.kind = MaterialKind::conductor;
  tinted.specular_color.value = {0.5f, 1, 1};
  scene.materials = {shiny, varnished, glazed, tinted};
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.uvs = {{0, 0}, {1, 0}, {0, 1}};
  mesh.triangles = {{0, 1, 2}};
  scene.meshes = {mesh, mesh, mesh, mesh};
  scene.meshes[3].material = 3;
  scene.meshes[1].material = 1;
  scene.meshes[2].material = 2;
  const std::vector<Warning> told = export_scene(scene, folder.path("out.glb"));
  CHECK(has_warning(told, "without refraction in the coat"));
  const Scene back = import_scene(folder.path("out.glb"));
  CHECK(back.warnings.total() == 0);
  const Material& n = back.materials[back.meshes[0].material];
  const Vec2 left{0.25f, 0.5f};
  CHECK(evaluate(back.textures, n.coat, left) == doctest::Approx(0.2).epsilon(1e-3));
  CHECK(n.coat_roughness.value == 0.25f);
  CHECK(n.iridescence.value == 0.5f);
  CHECK(n.film_ior == 1.4f);
  CHECK(n.film_thinnest_nm == 200);
  CHECK(n.film_thickest_nm == 700);
  CHECK(evaluate(back.textures, n.film_thickness, left) == doctest::Approx(0.2).epsilon(1e-3));
  const Rgb metal = back.materials[back.meshes[3].material].base_color.value;
  CHECK(metal.r == doctest::Approx(0.5 * double(metal.g)).epsilon(1e-4));
  const Material& g = back.materials[back.meshes[2].material];
  CHECK(g.transmission.value == 1);
  CHECK(g.coat.value == 0.5f);
  CHECK(g.coat_roughness.value == doctest::Approx(0.2));
  CHECK(has_warning(export_scene(scene, folder.path("out.pbrt")), "anything but metal"));
  // pbrt keeps the layer itself, and glTF's metal gets a layer.
  CHECK(has_warning(export_scene(scene, folder.path("out.pbrt")), "which refract light"));
  const Scene pbrt = import_scene(folder.path("out.pbrt"));
  REQUIRE(pbrt.materials.size() >= 2);
  const Material& v = pbrt.materials[pbrt.meshes[1].material];
  CHECK(v.kind == MaterialKind::conductor);
  CHECK(v.roughness.value == 0.2f);
  CHECK(v.coat_roughness.value == 0.05f);
  CHECK(v.coat_ior == 1.6f);
  check_near(v.eta, varnished.eta, 1e-6);
  const Material& factored = pbrt.materials[pbrt.meshes[3].material];
  CHECK(factored.is_reflectance);
  check_near(factored.base_color.value, metal, 1e-4);
  CHECK(pbrt.materials[pbrt.meshes[0].material].coat.value == 1);
}

TEST_CASE("absorption of glass survives, and losses cause warnings") {
  const TempFolder folder;
  const Scene scene = import_scene(folder.write(
      "in.pbrt",
      "WorldBegin\nMakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [1 3 0] "
      "\"rgb sigma_s\" [0 0 0]\nMediumInterface \"m\" \"\"\nMaterial \"dielectric\"\n"
      "Shape \"sphere\"\nMediumInterface \"\" \"\"\n"
      "Texture \"n\" \"float\" \"wrinkled\"\n"
      "Texture \"t\" \"spectrum\" \"mix\" \"texture amount\" \"n\"\n"
      "Material \"diffuse\" \"texture reflectance\" \"t\" \"texture displacement\" \"n\"\n"
      "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]\n"));
  for (const std::string name : {"out.pbrt", "out.gltf"}) {
    CAPTURE(name);
    const std::vector<Warning> lost = export_scene(scene, folder.path(name));
    CHECK(has_warning(lost, "bumps are not written"));
    CHECK(has_warning(lost, "patterns, noise"));
    const Scene back = import_scene(folder.path(name));
    size_t glasses = 0;
    for (const Material& m : back.materials) {
      if (m.absorption.is_black()) continue;
      ++glasses;
      check_near(m.absorption, {1, 3, 0}, 1e-4);
    }
    CHECK(glasses == 1);
  }
  // Backs: only glTF can express that they are invisible to the eye.
  Scene unseen = scene;
  for (Material& m : unseen.materials) m.back_faces = BackFaces::unseen;
  CHECK_FALSE(has_warning(export_scene(unseen, folder.path("b.gltf")), "back sides"));
  for (const Material& m : import_scene(folder.path("b.gltf")).materials)
    CHECK(m.back_faces == BackFaces::unseen);
  CHECK(has_warning(export_scene(unseen, folder.path("b.pbrt")), "back sides"));
}

TEST_CASE("a measured luminaire keeps its flux") {
  const TempFolder folder;
  Scene scene;
  LightWeb web;  // 3 cd below, nothing above
  web.vertical_angles_rad = {0, pi_f / 2, pi_f / 2 + 1e-4f, pi_f};
  web.horizontal_angles_rad = {0, 2 * pi_f};
  web.intensities = {3, 3, 0, 0, 3, 3, 0, 0};
  scene.webs.push_back(web);
  Light e;
  e.kind = LightKind::point;
  e.radiance = Rgb{2};
  e.web = 0;
  scene.lights.push_back(e);
  for (const std::string name : {"out.pbrt", "out.glb"}) {
    CHECK(has_warning(export_scene(scene, folder.path(name)), "measured luminaires"));
    const Scene back = import_scene(folder.path(name));
    const double unit = back.is_photometric ? luminous_efficacy : 1;
    check_near(back.lights.at(0).radiance, Rgb{float(3 * unit)}, 1e-3);
  }
}

TEST_CASE("only supported endings and existing folders are accepted") {
  CHECK_THROWS_AS(check_scene_format("a.obj"), UsageError);
  const TempFolder folder;
  CHECK_THROWS_AS(export_scene(Scene(), folder.path("none/a.glb")), EnvironmentError);
  export_scene(Scene(), folder.path("a.glb"));
  CHECK(import_scene(folder.path("a.glb")).meshes.empty());
}

TEST_CASE("instances stay instances in every format") {
  Scene scene = test::room_of_instances(test::places_in_room(), 24);
  scene.instances[1].name = "second";
  scene.origin = {1000, 0, 0};
  const TempFolder folder;
  for (const std::string name : {"out.pbrt", "out.gltf", "out.glb"}) {
    CAPTURE(name);
    const std::string path = folder.path(name);
    export_scene(scene, path, nullptr, Vec3{0, 1, 0});
    const std::string text = name == "out.glb" ? std::string() : text_of(path);
    if (name == "out.pbrt") {
      CHECK(count_of(text, "ObjectInstance") == scene.instances.size());
      CHECK(count_of(text, "plymesh") == scene.meshes.size() + 1);
    } else if (name == "out.gltf") {
      CHECK(count_of(text, "\"attributes\"") == scene.meshes.size() + 1);
      CHECK(count_of(text, "\"second\"") == 1);
    }
    const Scene back = import_scene(path);
    CHECK(triangle_count(back) == triangle_count(scene));
    // The reader copies so few instances: they appear at the instances' positions.
    REQUIRE(back.meshes.size() == scene.meshes.size() + scene.instances.size());
    const size_t first = back.meshes.size() - scene.instances.size();
    for (uint32_t k = 0; k < scene.instances.size(); ++k) {
      const MeshInWorld was = mesh_at(scene, first_instance(scene) + k);
      const Mesh& is = back.meshes[first + k];
      REQUIRE(is.triangles.size() == was.size());
      for (size_t t = 0; t < was.size(); ++t)
        for (size_t v = 0; v < 3; ++v) {
          const Vec3d p = Vec3d(is.positions[is.triangles[t][v]]) + back.origin;
          CHECK(length(p - (Vec3d(was.corners(t)[v]) + scene.origin)) < 1e-4);
        }
      CHECK(is.normals.size() == was.mesh().normals.size());
    }
  }
}

}  // namespace test_round_trip
