// Options, errors, progress and results of the public interface.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <string>

#include "troffer/troffer.h"

using namespace troffer;

namespace {

const std::string options_room = std::string(TROFFER_SOURCE_DIR) + "/scenes/kj92room/kj92room.gltf";

api::RenderOptions small(const std::string& method) {
  api::RenderOptions o;
  o.width = 16;
  o.height = 12;
  o.light.method = method;
  o.light.error = 0.3;
  o.light.spp = 1;
  return o;
}

// Returns the message of the UsageError that an action throws; empty if it throws none.
template <class Action>
std::string refusal(const Action& action) {
  try {
    action();
  } catch (const UsageError& e) {
    return e.what();
  }
  return "";
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

api::MeshData triangle() {
  api::MeshData mesh;
  mesh.name = "t";
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST_CASE("every method takes its options") {
  api::Scene scene = api::Scene::load(options_room);
  for (const std::string& method : api::method_names()) {
    CAPTURE(method);
    api::RenderOptions o = small(method);
    o.aovs = {"direct", "depth"};
    o.shadow_rays = 4;
    o.light.indirect = method == "kj92" ? "radiosity" : "none";
    const api::Picture picture = api::render(scene, o);
    CHECK(picture.width() == 16);
    CHECK(picture.height() == 12);
    CHECK(picture.is_complete());
    CHECK(picture.layer_names() == std::vector<std::string>{"direct", "depth"});
    CHECK(picture.layer("depth").channels == 1);
    CHECK(picture.statistics().viewing_rays > 0);
    CHECK(picture.statistics().end == "complete");
    CHECK(picture.png().size() > 50);
  }
}

TEST_CASE("options of kj92, crops and limits change the picture they are for") {
  api::Scene scene = api::Scene::load(options_room);
  api::RenderOptions o = small("kj92");
  const api::Image usual = api::render(scene, o).image();
  o.light.kj92 = {0.5, 4, 0.1, 2, 1, false, true, false, {}};
  CHECK(api::render(scene, o).image().pixels != usual.pixels);
  o.light.kj92 = {};
  o.light.kj92.select = {scene.light_names().front()};
  CHECK(api::render(scene, o).image().pixels != usual.pixels);

  o = small("path");
  const api::Image whole = api::render(scene, o).image();
  o.crop = {4, 2, 12, 8};
  const api::Image part = api::render(scene, o).image();
  CHECK(part.width == 8);
  CHECK(part.height == 6);
  CHECK(part.pixels[0] == whole.pixels[3 * (2 * 16 + 4)]);
  o.crop = {};
  o.error_limit = 0.5;
  o.light.spp = 0;
  CHECK(api::render(scene, o).statistics().estimated_error <= 0.5);
  o.error_limit = 0;
  o.light.spp = 1 << 16;
  o.time_limit = 0.2;
  const api::Picture late = api::render(scene, o);
  CHECK(late.statistics().end == "out_of_time");
  CHECK(late.statistics().unsampled == 0);
}

TEST_CASE("progress rises to the end, and stops the work where it returns false or throws") {
  api::Scene scene = api::Scene::load(options_room);
  double last = 0;
  const api::Picture done = api::render(scene, small("path"), [&](double f) {
    CHECK(f >= last);
    last = f;
    return true;
  });
  CHECK(done.is_complete());
  CHECK(last == doctest::Approx(1));
  for (const char* method : {"path", "kj92", "certified"}) {
    api::RenderOptions endless = small(method);
    endless.light.spp = 1 << 16;
    const api::Picture stopped = api::render(scene, endless, [](double) { return false; });
    CHECK_FALSE(stopped.is_complete());
    CHECK(stopped.statistics().end == "stopped");
    CHECK(stopped.width() == 16);
  }
  struct Enough {};
  CHECK_THROWS_AS(api::render(scene, small("path"), [](double) -> bool { throw Enough{}; }),
                  Enough);
  CHECK_FALSE(api::measure(scene, {{{1.5, 2.1, 0.77}, {0, 0, 1}}}, {}, [](double) {
                return false;
              }).is_complete);
}

TEST_CASE("meshes that cannot be are refused with what is wrong, and leave the scene as it was") {
  api::Scene scene;
  api::MeshData mesh = triangle();
  mesh.triangles.push_back({0, 1, 3});
  CHECK(refusal([&] { scene.add_mesh(mesh); }) == "mesh 't': triangle 1 names vertex 3 of 3");
  mesh = triangle();
  mesh.positions[2][1] = not_a_number;
  CHECK(refusal([&] { scene.add_mesh(mesh); }) == "mesh 't': position 2 is not finite");
  mesh = triangle();
  mesh.uvs.resize(2);
  CHECK(refusal([&] { scene.add_mesh(mesh); }) == "mesh 't': 2 uvs for 3 positions");
  mesh = triangle();
  mesh.material = "wal";
  scene.add_material("wall", api::Material::matte({0.5F, 0.5F, 0.5F}));
  CHECK(has(refusal([&] { scene.add_mesh(mesh); }),
            "no material is named 'wal'; did you mean 'wall'?"));
  mesh = triangle();
  mesh.emission = api::Emission{{-1, 0, 0}, false, {}, ""};
  CHECK(has(refusal([&] { scene.add_mesh(mesh); }), "radiance"));
  mesh.emission = api::Emission{{1, 0, 0}, false, {7}, ""};
  CHECK(has(refusal([&] { scene.add_mesh(mesh); }), "there is no texture 7"));
  mesh = triangle();
  mesh.triangles.clear();
  CHECK(has(refusal([&] { scene.add_mesh(mesh); }), "no triangles"));
  CHECK(scene.triangle_count() == 0);
  CHECK(scene.light_names().empty());
  CHECK(has(refusal([&] { api::render(scene); }), "the scene is empty"));
}

TEST_CASE("values without meaning are refused") {
  api::Scene scene = api::Scene::load(options_room);
  api::Material m = api::Material::metal({0.9F, 0.9F, 0.9F});
  m.roughness = 2;
  CHECK(has(refusal([&] { scene.add_material("x", m); }), "'x': roughness lies between 0 and 1"));
  CHECK(has(refusal([&] { scene.add_material("x", api::Material::glass(not_a_number)); }), "ior"));
  CHECK(has(refusal([&] { scene.light("moon"); }), "no light is named 'moon'"));
  CHECK(has(refusal([&] { scene.dim("moon*", 1); }), "no light is named"));
  CHECK(has(refusal([&] { scene.set_number(0, api::MaterialNumber::ior, 0.5); }), "ior"));
  CHECK(has(refusal([&] { scene.set_base_color(10000, {}); }), "there is no material 10000"));
  CHECK(has(refusal([&] { scene.add_light(api::Sky{"clear", {}, {}, 0, 0.2}); }), "sun"));
  CHECK(has(refusal([&] { scene.look_at({{1, 1, 1}, {1, 1, 1}}); }), "differ"));
  CHECK(has(refusal([&] { scene.add_environment({1, 1, {1, 1}}); }), "numbers"));
  const std::string words = refusal([&] {
    api::AddedLight asked;
    asked.date = "06-21T11:30";
    scene.add_light(asked);
  });
  CHECK(has(words, "date goes with weather"));
  CHECK_FALSE(has(words, "--"));
  const std::vector<api::MeasurePoint> bad{{{0, 0, 0}, {0, 0, 0}}};
  CHECK(has(refusal([&] { api::measure(scene, bad); }), "point 0: its normal"));
}

TEST_CASE("options out of range are refused") {
  api::Scene scene = api::Scene::load(options_room);
  const auto told = [&](const auto& change) {
    api::RenderOptions o = small("path");
    change(o);
    return refusal([&] { api::render(scene, o); });
  };
  CHECK(has(told([](auto& o) { o.light.method = "magic"; }), "no method 'magic'"));
  CHECK(has(told([](auto& o) { o.light.indirect = "magic"; }), "indirect"));
  CHECK(has(told([](auto& o) { o.light.error = 0; }), "error"));
  CHECK(has(told([](auto& o) { o.aovs = {"albdeo"}; }), "did you mean 'albedo'"));
  CHECK(has(told([](auto& o) { o.width = -1; }), "width"));
  CHECK(has(told([](auto& o) { o.shadow_rays = 0; }), "kj92"));
  CHECK(has(told([](auto& o) { o.light.kj92.variance = -1; }), "variance"));
  CHECK(has(told([](auto& o) { o.light.kj92.select = {"moon"}; }), "moon"));
  CHECK(has(told([](auto& o) { o.time_limit = -1; }), "time_limit"));
  CHECK(has(told([](auto& o) { o.crop = {0, 0, 99, 99}; }), "crop"));
  CHECK_THROWS_AS(api::Scene::load("scene.of-no-kind"), InputError);
  CHECK_THROWS_AS(api::Scene::load("none.gltf"), api::InputError);
}

TEST_CASE("files hold what the picture holds") {
  api::Scene scene = api::Scene::load(options_room);
  const api::Picture picture = api::render(scene, small("path"));
  const std::string path = (std::filesystem::temp_directory_path() / "troffer_api.exr").string();
  picture.save(path);
  CHECK(api::read_image(path).pixels == picture.image().pixels);
  std::filesystem::remove(path);
  CHECK_THROWS_AS(picture.save("/no/such/folder/a.exr"), EnvironmentError);
  CHECK(has(refusal([&] { picture.save("a.txt"); }), ".txt"));
  CHECK(api::compare_images(picture.image(), picture.image()).rmse == 0);
  CHECK(has(refusal([&] { api::write_image("a.exr", {2, 2, {}}); }), "12 numbers"));
}
