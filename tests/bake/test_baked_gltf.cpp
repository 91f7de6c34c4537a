// Files with baked light are valid glTF, can be read again, and render like the scene.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "bake/bake.h"
#include "export/export_scene.h"
#include "import/import.h"
#include "import/temp_folder.h"
#include "render/render.h"
#include "support/instanced_scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace test_baked_gltf {
using nlohmann::json;

namespace {

const StopFlag never_stop = false;

Scene room() {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.6f, 0.5f, 0.4f});
  add_box_inside(s, grey, {-2, -2, 0}, {2, 2, 2.5f});
  add_ceiling_light(s, 1, 2.4f, Rgb{10});
  s.instanced_meshes.push_back(dented_ball(grey, 12));
  for (const double x : {-1.0, 1.0})
    add_instance(s, 0, Affine::translate({x, 0, 0.6}) * Affine::scale({0.4, 0.4, 0.4}), "ball");
  return s;
}

struct Written {
  json file;
  std::vector<uint8_t> data;
};

Written written(const Scene& scene, BakedShading shading, const std::string& path,
                BakeResult* result = nullptr, int resolution = 128) {
  BakeOptions o;
  o.shading = shading;
  o.samples = 16;
  o.atlas.resolution = resolution;
  const PreparedScene prepared(as_meshes(scene));
  BakeResult r = bake(prepared, o, {}, never_stop);
  REQUIRE(r.is_complete);
  export_scene(r.scene, path, &r.baked, Vec3{0, 1, 0});  // keeps positions
  Written w;
  w.file = json::parse(std::ifstream(path));
  if (w.file.contains("buffers")) {
    const std::string folder = path.substr(0, path.find_last_of('/') + 1);
    std::ifstream in(folder + w.file["buffers"][0]["uri"].get<std::string>(), std::ios::binary);
    w.data.assign(std::istreambuf_iterator<char>(in), {});
  }
  if (result) *result = std::move(r);
  return w;
}

float float_at(const Written& w, const json& accessor, size_t component) {
  const json& view = w.file["bufferViews"][accessor["bufferView"].get<size_t>()];
  float value = 0;
  const size_t at = view["byteOffset"].get<size_t>() + 4 * component;
  REQUIRE(at + 4 <= w.data.size());
  std::memcpy(&value, w.data.data() + at, 4);
  return value;
}

// Checks what a validator does: bounds of positions, lengths, contiguous sets of coordinates,
// references, declared extensions.
void check_sound(const Written& w) {
  const json& f = w.file;
  CHECK(f["buffers"][0]["byteLength"] == w.data.size());
  for (const json& view : f["bufferViews"])
    CHECK(view["byteOffset"].get<size_t>() + view["byteLength"].get<size_t>() <= w.data.size());
  for (const json& mesh : f["meshes"]) {
    for (const json& p : mesh["primitives"]) {
      std::set<std::string> names;
      for (const auto& [name, index] : p["attributes"].items()) names.insert(name);
      for (int set = 1; set < 3; ++set)
        if (names.count("TEXCOORD_" + std::to_string(set)) > 0)
          CHECK(names.count("TEXCOORD_" + std::to_string(set - 1)) == 1);
      const json& positions = f["accessors"][p["attributes"]["POSITION"].get<size_t>()];
      for (const auto& [name, index] : p["attributes"].items()) {
        const json& a = f["accessors"][index.get<size_t>()];
        CHECK(a["count"] == positions["count"]);
        const bool is_uv = name == "TEXCOORD_1";  // the lightmap's coordinates
        for (size_t i = 0; is_uv && i < 2 * a["count"].get<size_t>(); ++i) {
          const float v = float_at(w, a, i);
          CHECK((v >= 0 && v <= 1));
        }
      }
      for (size_t k = 0; k < 3; ++k) {
        float least = 1e30f, most = -1e30f;
        for (size_t i = 0; i < positions["count"].get<size_t>(); ++i) {
          const float v = float_at(w, positions, 3 * i + k);
          least = std::min(least, v), most = std::max(most, v);
        }
        CHECK(least == positions["min"][k].get<float>());
        CHECK(most == positions["max"][k].get<float>());
      }
      CHECK(p["material"].get<size_t>() < f["materials"].size());
    }
  }
  const std::string text = f.dump();
  for (const char* name :
       {"MOZ_lightmap", "KHR_materials_unlit", "KHR_materials_emissive_strength"}) {
    const json used = f.value("extensionsUsed", json::array());
    const bool is_named = std::find(used.begin(), used.end(), name) != used.end();
    const bool is_used = f["materials"].dump().find(name) != std::string::npos;
    CHECK(is_named == is_used);
  }
}

}  // namespace

TEST_CASE(
    "lightmaps are written to valid files, and instances share all but their texture coordinates") {
  const TempFolder folder;
  BakeResult r;
  const Written w = written(room(), BakedShading::lightmap, folder.path("room.gltf"), &r);
  check_sound(w);
  std::vector<json> balls;
  for (const json& node : w.file["nodes"])
    if (node.value("name", "") == "ball")
      balls.push_back(w.file["meshes"][node["mesh"].get<size_t>()]["primitives"][0]);
  REQUIRE(balls.size() == 2);
  CHECK(balls[0]["attributes"]["POSITION"] == balls[1]["attributes"]["POSITION"]);
  CHECK(balls[0]["attributes"]["TEXCOORD_0"] == balls[1]["attributes"]["TEXCOORD_0"]);
  CHECK(balls[0]["attributes"]["TEXCOORD_1"] != balls[1]["attributes"]["TEXCOORD_1"]);
  CHECK(balls[0]["indices"] == balls[1]["indices"]);
  const json& material = w.file["materials"][balls[0]["material"].get<size_t>()];
  const json& light = material["extensions"]["MOZ_lightmap"];
  CHECK(light["texCoord"] == 1);
  CHECK(light["intensity"].get<double>() == doctest::Approx(r.baked.white));
  CHECK(w.file["asset"]["extras"]["lightmap"]["white"].get<double>() ==
        doctest::Approx(r.baked.white));
  // The mean of the file's light, as an engine reads it, equals the computed mean.
  const Scene again = import_scene(folder.path("room.gltf"));
  CHECK(triangle_count(again) == triangle_count(r.scene));
  size_t with_second = 0;
  for (const Mesh& m : again.meshes) with_second += !m.uvs_2.empty();
  CHECK(again.lights.size() == 1);
}

TEST_CASE("a room of surfaces that emit their reflected light looks like the original") {
  const TempFolder folder;
  const Scene scene = room();
  const Written w = written(scene, BakedShading::emissive, folder.path("room.gltf"));
  check_sound(w);
  const Scene again = import_scene(folder.path("room.gltf"));
  // View from the middle toward a corner.
  Camera c;
  c.position = {-1.8f, -1.8f, 1.5f};
  c.forward = normalize(Vec3{1, 1, -0.3f});
  c.right = normalize(cross(c.forward, Vec3{0, 0, 1}));
  c.up = cross(c.right, c.forward);
  c.half_extent = 0.7f;
  const auto picture = [&](Scene s, int depth, double scale) {
    RenderOptions o;
    o.method = Method::path;
    o.depth = depth;
    o.spp = depth == 0 ? 16 : 256;
    o.width = o.height = 48;
    const PreparedScene prepared(std::move(s));
    const RenderResult r = render(prepared, c, o, {}, never_stop);
    std::vector<double> out;
    for (const Rgb& p : r.layers[0].image.pixels) out.push_back(double(luminance(p)) * scale);
    return out;
  };
  const std::vector<double> was = picture(scene, -1, luminous_efficacy);
  const std::vector<double> is = picture(again, 0, 1);
  double off = 0, sum = 0;
  size_t counted = 0;
  for (size_t i = 0; i < was.size(); ++i) {
    if (was[i] > 1500) continue;  // the lamp itself
    off += std::abs(is[i] - was[i]);
    sum += was[i];
    ++counted;
  }
  CHECK(counted > was.size() / 2);
  CHECK(off / sum < 0.06);
}

TEST_CASE("a lightmap is reported when a file is read, and shown with --baked") {
  const TempFolder folder;
  const Scene scene = room();
  written(scene, BakedShading::lightmap, folder.path("room.gltf"));
  const Scene plain = import_scene(folder.path("room.gltf"));
  REQUIRE(!plain.warnings.entries().empty());
  CHECK(plain.warnings.entries()[0].text.find("MOZ_lightmap") != std::string::npos);
  ImportOptions options;
  options.shows_baked = true;
  const Scene shown = import_scene(folder.path("room.gltf"), options);
  CHECK(shown.warnings.entries().empty());
  for (const Mesh& m : shown.meshes) {
    CHECK(!m.lights.empty());
    CHECK(shown.materials[m.material].kind == MaterialKind::diffuse);
  }
  // Mean of a wall, which sends base colour × E / π.
  Camera c;
  c.position = {0, 0, 1.2f};
  c.forward = {1, 0, 0};
  c.right = {0, -1, 0};
  c.up = {0, 0, 1};
  c.half_extent = 0.3f;
  const auto mean = [&](Scene s, int depth, double scale) {
    RenderOptions o;
    o.method = Method::path;
    o.depth = depth;
    o.spp = depth == 0 ? 16 : 256;
    o.width = o.height = 24;
    const RenderResult r = render(PreparedScene(std::move(s)), c, o, {}, never_stop);
    double sum = 0;
    for (const Rgb& p : r.layers[0].image.pixels) sum += double(luminance(p)) * scale;
    return sum / (24 * 24);
  };
  CHECK(mean(shown, 0, 1) == doctest::Approx(mean(scene, -1, luminous_efficacy)).epsilon(0.05));
}

TEST_CASE("unlit images and vertex colours follow their glTF extensions") {
  const TempFolder folder;
  BakeResult r;
  const Written unlit = written(room(), BakedShading::unlit, folder.path("unlit.gltf"), &r);
  check_sound(unlit);
  const Written colors =
      written(room(), BakedShading::vertex_colors, folder.path("colors.gltf"), &r);
  check_sound(colors);
  size_t with_colors = 0;
  for (const json& mesh : colors.file["meshes"]) {
    const json& p = mesh["primitives"][0];
    if (!p["attributes"].contains("COLOR_0")) continue;
    ++with_colors;
    const json& a = colors.file["accessors"][p["attributes"]["COLOR_0"].get<size_t>()];
    CHECK(a["componentType"] == 5126);
    CHECK(colors.file["materials"][p["material"].get<size_t>()]["extensions"].contains(
        "KHR_materials_unlit"));
  }
  CHECK(with_colors == 8);
}

TEST_CASE("hostile meshes are baked or left dark, and nothing worse") {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  const float nan = std::nanf("");
  Mesh bad;
  bad.material = grey;
  bad.positions = {{0, 0, 0}, {1, 0, 0}, {1e-9f, 1e-9f, 0}, {0, 1, 0}, {1, 1, 1e-7f}, {5, 5, 5}};
  bad.normals.assign(6, Vec3{0, 0, 0});
  bad.uvs.assign(6, Vec2{nan, 1e30f});
  bad.uvs_2.assign(6, Vec2{nan, -3});
  bad.triangles = {{0, 1, 2}, {0, 1, 3}, {1, 4, 3}, {0, 1, 3}, {1, 0, 3}, {3, 3, 3}, {0, 5, 5}};
  s.meshes.push_back(bad);
  Mesh fan;  // slivers that all share one edge
  fan.material = grey;
  fan.positions = {{0, 0, 1}, {0.5f, 0, 1}};
  for (int i = 0; i < 200; ++i) {
    fan.positions.push_back({0.25f, 1e-4f * float(i + 1), 1 + 1e-5f * float(i % 7)});
    fan.triangles.push_back({0, 1, uint32_t(i + 2)});
  }
  s.meshes.push_back(fan);
  s.meshes.push_back(Mesh{});
  add_ceiling_light(s, 1, 2, Rgb{10});
  const TempFolder folder;
  for (const BakedShading shading : {BakedShading::lightmap, BakedShading::unlit,
                                     BakedShading::vertex_colors, BakedShading::emissive}) {
    BakeResult r;
    written(s, shading, folder.path("bad.gltf"), &r, 48);
    for (const Image& page : r.irradiance)
      for (const Rgb& p : page.pixels) CHECK(is_finite(p));
    CHECK(std::isfinite(r.figures.mean_lx));
    CHECK(triangle_count(import_scene(folder.path("bad.gltf"))) > 0);
  }
}

}  // namespace test_baked_gltf
