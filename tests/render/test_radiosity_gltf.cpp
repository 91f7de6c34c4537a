// Export of a radiosity solution as glTF, and the façade that computes, saves and loads solutions.
#include <doctest/doctest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include "base/error.h"
#include "import/import.h"
#include "render/radiosity.h"
#include "render/radiosity_gltf.h"
#include "support/scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace {

Scene small_room() {
  Scene s;
  const auto walls = add_box_inside(s, add_diffuse(s, Rgb{0.5f}), {0, 0, 0}, {4, 3, 2.5f});
  s.meshes[walls[0]].material = add_diffuse(s, {0.8f, 0.2f, 0.1f});
  const uint32_t lamp =
      add_quad(s, add_diffuse(s, Rgb{0}),
               {Vec3{1.5f, 1, 2.4f}, {1.5f, 2, 2.4f}, {2.5f, 2, 2.4f}, {2.5f, 1, 2.4f}});
  make_light(s, lamp, Rgb{10});
  return s;
}

RadiosityOptions coarse() {
  RadiosityOptions o;
  o.meshing.element_size = 0.6f;
  o.meshing.patch_size = 1.8f;
  o.unshot_fraction = 0.05f;
  return o;
}

RadiositySolution solve(const PreparedScene& scene, const RadiosityOptions& o) {
  const StopFlag never = false;
  return preprocess(scene, o, 2, {}, never).solution;
}

// A temporary file, deleted at the end of its scope.
struct TemporaryFile {
  TemporaryFile(const char* name, const std::vector<uint8_t>& bytes)
      : path((std::filesystem::temp_directory_path() /
              ("troffer-" + std::to_string(getpid()) + "-" + name))
                 .string()) {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  }
  ~TemporaryFile() { std::filesystem::remove(path); }
  const std::string path;
};

template <class T>
T value_at(const std::vector<uint8_t>& bytes, size_t at) {
  T v;
  REQUIRE(at + sizeof(T) <= bytes.size());
  std::memcpy(&v, bytes.data() + at, sizeof(T));
  return v;
}

}  // namespace

TEST_CASE("the displayable mesh is valid glTF with every side that light reaches") {
  const PreparedScene scene(small_room());
  const RadiositySolution s = solve(scene, coarse());
  size_t sides = 0;
  for (const Fragment& f : s.mesh.fragments)
    for (const uint32_t p : s.mesh.element_points[f.element]) sides += p != no_point;
  REQUIRE(sides > 100);
  for (const GltfContainer container : {GltfContainer::text, GltfContainer::binary}) {
    const bool is_text = container == GltfContainer::text;
    const TemporaryFile file(is_text ? "a.gltf" : "a.glb",
                             radiosity_gltf(scene.scene, s, container));
    const Scene back = import_scene(file.path);
    CHECK(triangle_count(back) == sides);
    CHECK(back.lights.empty());
    const Box a = bounds(scene.scene), b = bounds(back);
    CHECK(length(a.lower - b.lower) < 1e-5f);
    CHECK(length(a.upper - b.upper) < 1e-5f);
    for (const auto& w : back.warnings.entries()) {
      CAPTURE(w.text);
      bool is_known = false;
      for (const char* part : {"COLOR_0", "2 scenes", "no light", "camera", "unlit", "lines"})
        is_known = is_known || w.text.find(part) != std::string::npos;
      CHECK(is_known);
    }
  }
}

TEST_CASE("colours of the displayable mesh are radiosity times exposure") {
  const PreparedScene scene(small_room());
  const RadiositySolution s = solve(scene, coarse());
  const std::vector<uint8_t> bytes = radiosity_gltf(scene.scene, s, GltfContainer::binary);
  REQUIRE(value_at<uint32_t>(bytes, 0) == 0x46546c67);
  CHECK(value_at<uint32_t>(bytes, 8) == bytes.size());
  const uint32_t json_size = value_at<uint32_t>(bytes, 12);
  CHECK(json_size % 4 == 0);
  const std::string json(bytes.begin() + 20, bytes.begin() + 20 + json_size);
  const size_t binary = 20 + json_size + 8;
  CHECK(value_at<uint32_t>(bytes, binary - 8) == bytes.size() - binary);
  const size_t at = json.find("\"exposure\":");
  REQUIRE(at != std::string::npos);
  const double exposure = std::stod(json.substr(at + 11));
  const size_t counted = json.find("\"count\":");  // accessor 0 holds positions, accessor 1 colours
  REQUIRE(counted != std::string::npos);
  const auto count = size_t(std::stoul(json.substr(counted + 8)));
  double floor_sum = 0, floor_count = 0;
  bool has_lamp = false;
  for (size_t i = 0; i < count; ++i) {
    const Vec3 p = value_at<Vec3>(bytes, binary + 12 * i);
    const Rgb c = value_at<Rgb>(bytes, binary + 12 * (count + i));
    for (size_t k = 0; k < 3; ++k) {
      CHECK(c[k] >= 0);
      CHECK(c[k] <= 1);
    }
    if (p.z == 2.4f && c == Rgb{1}) has_lamp = true;
    if (p.z > 0 || p.x <= 0 || p.y <= 0 || p.x >= 4 || p.y >= 3 || c.r == 1) continue;
    CHECK(c.g < 0.26f * c.r);  // the floor is red
    floor_sum += double(c.r);
    floor_count += 1;
  }
  CHECK(has_lamp);
  REQUIRE(floor_count > 0);
  double least = 1e9, most = 0;
  for (uint32_t i = 0; i < s.mesh.points.size(); ++i) {
    if (s.mesh.points[i].position.z > 0) continue;
    const double b = 0.8 * double(s.irradiance(i).r + s.ambient.r) * exposure;
    least = std::min(least, b);
    most = std::max(most, b);
  }
  CHECK(floor_sum / floor_count > least);
  CHECK(floor_sum / floor_count < most);
}

TEST_CASE("the displayable mesh of an empty scene is a file too") {
  for (const bool is_dark : {false, true}) {
    Scene s;
    if (is_dark) add_box_inside(s, add_diffuse(s, Rgb{0.5f}), {0, 0, 0}, {1, 1, 1});
    const PreparedScene scene(std::move(s));
    const RadiositySolution solution = solve(scene, coarse());
    CHECK(solution.is_complete);
    for (const GltfContainer c : {GltfContainer::text, GltfContainer::binary}) {
      const std::vector<uint8_t> bytes = radiosity_gltf(scene.scene, solution, c);
      const std::string text(bytes.begin(), bytes.end());
      CHECK(text.find("\"version\":\"2.0\"") != std::string::npos);
      CHECK(text.find("meshes") == std::string::npos);
    }
  }
}

TEST_CASE("scenes with other up axes are rotated") {
  Scene s = small_room();
  Camera c;  // z up and left-handed, as in pbrt
  c.right = {1, 0, 0};
  c.up = {0, 0, 1};
  c.forward = {0, 1, 0};
  CHECK(dot(cross(c.right, c.up), c.forward) < 0);
  s.cameras.push_back(c);
  const PreparedScene right_handed(s);
  s.cameras[0].right = {-1, 0, 0};
  const PreparedScene left_handed(s);
  for (const PreparedScene* scene : {&right_handed, &left_handed}) {
    const TemporaryFile file(
        "b.gltf", radiosity_gltf(scene->scene, solve(*scene, coarse()), GltfContainer::text));
    const Box box = bounds(import_scene(file.path));
    CHECK(box.upper.y == doctest::Approx(2.5f));
    CHECK(box.extent().z == doctest::Approx(3));
    CHECK((box.lower.z < -1) == (scene == &right_handed));
  }
}

TEST_CASE("a solution can be saved and loaded; progress rises to the end") {
  const PreparedScene scene(small_room());
  const StopFlag never = false;
  double last = -1;
  const RadiosityResult r = preprocess(
      scene, coarse(), 2,
      [&](double f) {
        CHECK(f >= last);
        CHECK(f <= 1);
        last = f;
      },
      never);
  CHECK(last == doctest::Approx(1).epsilon(0.01));
  CHECK(r.seconds > 0);
  const std::vector<uint8_t> bytes = save_radiosity(scene, r.solution);
  CHECK(load_radiosity(scene, bytes, "f", nullptr, 2).general == r.solution.general);
  RadiosityOptions other = coarse();
  CHECK(load_radiosity(scene, bytes, "f", &other, 2).general == r.solution.general);
  other.stored_per_point = 2;
  CHECK_THROWS_AS(load_radiosity(scene, bytes, "f", &other, 2), InputError);
}

TEST_CASE("senseless options are refused") {
  const auto refused = [](auto change) {
    RadiosityOptions o;
    change(o);
    CHECK_THROWS_AS(check(o), UsageError);
  };
  CHECK_NOTHROW(check(RadiosityOptions{}));
  refused([](RadiosityOptions& o) { o.meshing.element_size = -1; });
  refused([](RadiosityOptions& o) { o.meshing.element_size = NAN; });
  refused([](RadiosityOptions& o) { o.meshing.patch_size = INFINITY; });
  refused([](RadiosityOptions& o) { o.meshing = {.element_size = 1, .patch_size = 0.5f}; });
  refused([](RadiosityOptions& o) { o.unshot_fraction = 0; });
  refused([](RadiosityOptions& o) { o.unshot_fraction = NAN; });
  refused([](RadiosityOptions& o) { o.stored_per_point = 65; });
  refused([](RadiosityOptions& o) { o.max_rays = 0; });
}
