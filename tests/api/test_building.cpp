// Scenes that are built from arrays: they give the same pictures as files, and light agrees with
// closed forms.
#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "import/import.h"
#include "troffer/troffer.h"

using namespace troffer;

namespace {

const std::string room_file = std::string(TROFFER_SOURCE_DIR) + "/scenes/kj92room/kj92room.gltf";

api::MeshData quad(const api::Point& a, const api::Point& b, const api::Point& c,
                   const api::Point& d) {
  api::MeshData mesh;
  mesh.positions = {a, b, c, d};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

// Builds the room of the file again from its arrays.
api::Scene rebuilt(const Scene& from) {
  api::Scene scene({{0, 1, 0}, from.is_photometric});
  for (size_t i = 0; i < from.materials.size(); ++i) {
    const Material& m = from.materials[i];
    REQUIRE(m.base_color.texture < 0);
    api::Material made;
    made.model = m.kind == MaterialKind::diffuse ? api::MaterialModel::matte
                                                 : api::MaterialModel::principled;
    made.base_color = {m.base_color.value.r, m.base_color.value.g, m.base_color.value.b};
    made.roughness = double(m.roughness.value);
    made.metallic = double(m.metallic.value);
    made.specular = double(m.specular.value);
    made.back_face =
        m.back_faces == BackFaces::unseen ? api::BackFace::unseen : api::BackFace::shown;
    scene.add_material("m" + std::to_string(i), made);
  }
  for (const Mesh& mesh : from.meshes) {
    api::MeshData made;
    made.name = mesh.name;
    for (const Vec3& p : mesh.positions)
      made.positions.push_back({double(p.x), double(p.y), double(p.z)});
    for (const Vec3& n : mesh.normals) made.normals.push_back({n.x, n.y, n.z});
    made.triangles = mesh.triangles;
    made.material = "m" + std::to_string(mesh.material);
    if (!mesh.lights.empty() && mesh.lights[0] >= 0) {
      const Light& e = from.lights[size_t(mesh.lights[0])];
      made.emission =
          api::Emission{{e.radiance.r, e.radiance.g, e.radiance.b}, e.is_two_sided, {}, e.name};
    }
    scene.add_mesh(made);
  }
  return scene;
}

api::RenderOptions quick(const std::string& method) {
  api::RenderOptions o;
  o.width = 32;
  o.height = 24;
  o.light.method = method;
  o.light.error = 0.2;
  o.light.spp = 2;
  return o;
}

api::Image picture_of(api::Scene& scene, const std::string& method) {
  const api::Camera view = scene.look_at({{0.5, 0.5, 1.6}, {2.5, 2, 1}, api::Point{0, 0, 1}, 75});
  return api::render(scene, view, quick(method)).image();
}

// Returns irradiance over radiance of a horizontal square of side 2a, at height h above a
// horizontal receiver below its middle. Lambert's polygon formula: 4 (a / s) atan(a / s), s =
// sqrt(a² + h²).
double square_over_point(double a, double h) {
  const double s = std::hypot(a, h);
  return 4 * (a / s) * std::atan(a / s);
}

}  // namespace

TEST_CASE("a room from arrays is the room of the file, pixel by pixel") {
  const Scene read = import_scene(room_file);
  REQUIRE(read.instances.empty());
  api::Scene from_file = api::Scene::load(room_file), from_arrays = rebuilt(read);
  CHECK(from_arrays.triangle_count() == from_file.triangle_count());
  CHECK(from_arrays.bounds() == from_file.bounds());
  for (const char* method : {"path", "certified"}) {
    const api::Image a = picture_of(from_file, method), b = picture_of(from_arrays, method);
    CAPTURE(method);
    CHECK(a.pixels.size() == 32 * 24 * 3);
    CHECK(a.pixels == b.pixels);
  }
}

TEST_CASE("a square lamp lights the point below it as the closed form says") {
  for (const bool is_photometric : {true, false}) {
    api::Scene scene({{0, 0, 1}, is_photometric});
    api::MeshData lamp = quad({-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 2});
    lamp.name = "lamp";
    lamp.emission = api::Emission{{100, 200, 300}, false, {}, ""};
    scene.add_mesh(lamp);
    const auto found = api::measure(scene, {{{0, 0, 0}, {0, 0, 1}}, {{0, 0, 3}, {0, 0, -1}}});
    REQUIRE(found.is_complete);
    const double expected = square_over_point(1, 2);
    CHECK(double(found.values[0].irradiance[0]) == doctest::Approx(100 * expected).epsilon(1e-3));
    CHECK(double(found.values[0].irradiance[2]) == doctest::Approx(300 * expected).epsilon(1e-3));
    CHECK(found.values[1].illuminance == 0);  // the lamp's back emits nothing
    scene.set_dimmer("lamp", 0.5);
    const auto dimmed = api::measure(scene, {{{0, 0, 0}, {0, 0, 1}}});
    CHECK(double(dimmed.values[0].irradiance[0]) == doctest::Approx(50 * expected).epsilon(1e-3));
  }
}

TEST_CASE("a transform, a far place and normals leave the light what it is") {
  const double expected = 100 * square_over_point(1, 2);
  api::Scene scene;
  api::MeshData lamp = quad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
  lamp.normals.assign(4, {0, 0, -1});
  lamp.transform = {{{1, 0, 0, 350000}, {0, 1, 0, 5600000}, {0, 0, 1, 102}}};
  lamp.emission = api::Emission{{100, 100, 100}, false, {}, "far"};
  scene.add_mesh(lamp);
  const auto found = api::measure(scene, {{{350000, 5600000, 100}, {0, 0, 2}}});
  CHECK(found.values[0].illuminance == doctest::Approx(expected).epsilon(1e-3));
  CHECK(scene.bounds().first == api::Point{349999, 5599999, 102});
  const api::Camera view =
      scene.look_at({{350000, 5600000, 100}, {350000, 5600000, 102}, api::Point{0, 1, 0}});
  const api::Image seen = api::render(scene, view, quick("path")).image();
  CHECK(double(seen.pixels[3 * (12 * 32 + 16)]) == doctest::Approx(100).epsilon(1e-4));
}

TEST_CASE("lamps without a surface follow the inverse square and the cosine") {
  api::Scene scene;
  scene.add_mesh(quad({-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}));
  scene.add_light(api::PointLight{"point", {0, 0, 2}, {80, 80, 80}});
  scene.add_light(api::SpotLight{"spot", {0, 0, 2}, {0, 0, -1}, {40, 40, 40}, 10, 20});
  scene.add_light(api::DistantLight{"sun", {0, 0, -3}, {7, 7, 7}});
  const auto lux = [&](const char* name) {
    for (const std::string& other : scene.light_names())
      scene.set_dimmer(other, other == name ? 1 : 0);
    return api::measure(scene, {{{0, 0, 1e-4}, {0, 0, 1}}, {{2, 0, 1e-4}, {0, 0, 1}}});
  };
  const auto point = lux("point"), spot = lux("spot"), sun = lux("sun");
  CHECK(point.values[0].illuminance == doctest::Approx(20).epsilon(2e-3));
  CHECK(point.values[1].illuminance == doctest::Approx(80 / 8.0 * std::sqrt(0.5)).epsilon(2e-3));
  CHECK(spot.values[0].illuminance == doctest::Approx(10).epsilon(2e-3));
  CHECK(spot.values[1].illuminance == 0);
  CHECK(sun.values[1].illuminance == doctest::Approx(7).epsilon(2e-3));
}

TEST_CASE("an even environment lights a free point with pi times its radiance") {
  api::Scene scene;
  scene.add_mesh(quad({-1, -1, -9}, {1, -1, -9}, {1, 1, -9}, {-1, 1, -9}));
  scene.add_environment({4, 2, std::vector<float>(24, 2.0F)}, 1.5);
  const auto found = api::measure(scene, {{{0, 0, 0}, {0, 0, 1}}});
  CHECK(found.values[0].illuminance == doctest::Approx(3 * 3.14159265).epsilon(5e-3));
  CHECK(scene.light("environment").kind == "environment");
}

TEST_CASE("textures are looked up by texture coordinates, the first row on top") {
  api::Scene scene;
  api::TextureImage image;
  image.width = 1;
  image.height = 2;
  image.channels = 3;
  image.floats = {1, 0, 0, 0, 0, 1};
  image.is_filtered = image.is_repeated = false;
  api::Material m = api::Material::matte({1, 1, 1});
  m.base_color_texture = scene.add_texture(image);
  scene.add_material("striped", m);
  api::MeshData wall = quad({-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1});
  wall.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  wall.material = "striped";
  scene.add_mesh(wall);
  api::RenderOptions o = quick("path");
  o.width = o.height = 16;
  o.aovs = {"albedo"};
  const api::Picture picture =
      api::render(scene, scene.look_at({{0, -2, 0}, {0, 0, 0}, {}, 30}), o);
  const api::PixelView albedo = picture.layer("albedo");
  const auto at = [&](int y, int channel) {
    return double(
        albedo.data[(std::ptrdiff_t(y) * albedo.width + 8) * albedo.pixel_step + channel]);
  };
  CHECK(at(3, 0) > 0.9);
  CHECK(at(3, 2) < 0.1);
  CHECK(at(12, 0) < 0.1);
  CHECK(at(12, 2) > 0.9);
}

TEST_CASE("a copy of a scene is changed by itself") {
  api::Scene scene;
  scene.add_light(api::PointLight{"a", {0, 0, 1}, {1, 1, 1}});
  api::Scene copy = scene;
  copy.set_dimmer("a", 0.25);
  copy.dim("*", 0.5);
  CHECK(scene.light("a").dimmer == 1);
  CHECK(copy.light("a").dimmer == 0.5);
  copy.add_light(api::PointLight{"b", {0, 0, 1}, {1, 1, 1}});
  CHECK(scene.light_names().size() == 1);
}
