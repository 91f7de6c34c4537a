// Honeybee models: geometry with openings, modifiers by Honeybee's rules, units, states, grids,
// views, what is named in warnings, broken files.
#include "import/hbjson/hbjson.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"
#include "import/hbjson/hbjson_face.h"
#include "import/import.h"
#include "import/mesh_clean.h"
#include "mutations.h"
#include "support/hbjson_room.h"
#include "support/klems.h"
#include "temp_folder.h"

using namespace troffer;
using namespace troffer::test;

namespace test_hbjson {

namespace {

Scene import_text(const std::string& text, const std::map<std::string, size_t>& states = {}) {
  const TempFolder folder;
  ImportOptions options;
  options.states = states;
  return import_scene(folder.write("m.hbjson", text), options);
}

std::string error_of(const std::string& text) {
  try {
    import_text(text);
  } catch (const InputError& e) {
    const std::string what = e.what();
    return what.substr(what.find("m.hbjson"));
  }
  return "";
}

// Area and mean normal (times area) of the surfaces of a material.
struct Look {
  double area = 0;
  Vec3d normal;
};
Look look_of(const Scene& scene, const std::string& material) {
  Look out;
  for (const Mesh& m : scene.meshes)
    if (scene.materials[m.material].name == material)
      for (const Triangle& t : m.triangles) {
        const Vec3d n = area_vector(m, t) * 0.5;
        out.area += length(n);
        out.normal += n;
      }
  return out;
}

bool warns_of(const Scene& scene, const std::string& text) {
  const auto& all = scene.warnings.entries();
  return std::any_of(all.begin(), all.end(),
                     [&](const Warning& w) { return w.text.find(text) != std::string::npos; });
}

const Material& material_named(const Scene& scene, const std::string& name) {
  for (const Material& m : scene.materials)
    if (m.name == name) return m;
  FAIL("no material ", name);
  return scene.materials[0];
}

}  // namespace

TEST_CASE("a room without modifiers has Honeybee's generic ones, its faces turned inwards") {
  const Scene scene = import_text(HbjsonRoom().text());
  const Look floor = look_of(scene, "generic_floor_0.20");
  CHECK(floor.area == doctest::Approx(12));
  CHECK(floor.normal.z == doctest::Approx(12));
  CHECK(look_of(scene, "generic_ceiling_0.80").normal.z == doctest::Approx(-12));
  // Walls of 10, 10, 7.5 and 7.5 m² without the window of 2 m².
  const Look walls = look_of(scene, "generic_wall_0.50");
  CHECK(walls.area == doctest::Approx(35 - 2));
  CHECK(walls.normal.y == doctest::Approx(-2));  // the north wall looks south, the south one north
  const Look window = look_of(scene, "generic_exterior_window_vis_0.64");
  CHECK(window.area == doctest::Approx(2));
  CHECK(window.normal.y == doctest::Approx(2));
  CHECK(look_of(scene, "generic_context_0.20").area == doctest::Approx(4));
  CHECK(material_named(scene, "generic_wall_0.50").base_color.value == Rgb{0.5f});
  // Visible transmittance at normal incidence: T = .92 t for t ≈ .6976 and an index of 1.52.
  const Material& glass = material_named(scene, "generic_exterior_window_vis_0.64");
  CHECK(double(std::exp(-glass.absorption.g)) == doctest::Approx(0.6975762));
  CHECK(std::any_of(scene.meshes.begin(), scene.meshes.end(),
                    [](const Mesh& m) { return m.name == "Office"; }));
}

TEST_CASE("units, grids and views become metres and cameras") {
  HbjsonRoom feet;
  feet.units = "Feet";
  feet.scale = 1 / 0.3048;
  const Scene scene = import_text(feet.text());
  CHECK(look_of(scene, "generic_floor_0.20").area == doctest::Approx(12));
  REQUIRE(scene.grids.size() == 1);
  CHECK(scene.grids[0].name == "desk");
  CHECK(scene.grids[0].room == "room_1");
  REQUIRE(scene.grids[0].positions.size() == 2);
  CHECK(scene.grids[0].positions[0].z == doctest::Approx(0.8));
  CHECK(scene.grids[0].directions[0] == Vec3{0, 0, 1});
  REQUIRE(scene.cameras.size() == 1);
  CHECK(scene.cameras[0].kind == CameraKind::fisheye);
  CHECK(double(scene.cameras[0].half_extent) == doctest::Approx(pi / 2));
  CHECK(double(scene.cameras[0].position.y) == doctest::Approx(2.5));
  HbjsonRoom unknown;
  unknown.units = "Cubits";
  CHECK(error_of(unknown.text()).find("/units: is not Meters") != std::string::npos);
}

TEST_CASE("modifiers come from the part, the room's set, the global set, in this order") {
  HbjsonRoom room;
  room.modifiers =
      R"({"type":"Plastic","identifier":"own","r_reflectance":0.3,"g_reflectance":0.3,"b_reflectance":0.3},
         {"type":"Glass","identifier":"pane","r_transmissivity":0.9,"g_transmissivity":0.9,"b_transmissivity":0.9},)";
  room.window = R"("modifier":"own")";
  room.set = R"("modifier_set":"warm")";
  room.radiance =
      R"("modifier_sets":[{"type":"ModifierSetAbridged","identifier":"warm",
           "wall_set":{"exterior_modifier":"own","interior_modifier":null},"floor_set":null}],
         "global_modifier_set":{"type":"GlobalModifierSet",
           "wall_set":{"exterior_modifier":"pane"},
           "floor_set":{"exterior_modifier":"own"}},)";
  const Scene scene = import_text(room.text());
  // Window of 2 m², walls of 33 m², the global set's floor of 12 m².
  CHECK(look_of(scene, "own").area == doctest::Approx(2 + 33 + 12));
  CHECK(look_of(scene, "pane").area == 0);
  CHECK(look_of(scene, "generic_ceiling_0.80").area == doctest::Approx(12));
  // Faces that are not outdoors take the interior modifiers.
  room.boundary = "Adiabatic";
  const Scene inner = import_text(room.text());
  CHECK(look_of(inner, "own").area == doctest::Approx(2));
  CHECK(look_of(inner, "generic_wall_0.50").area == doctest::Approx(33));
  HbjsonRoom lacking;
  lacking.window = R"("modifier":"nowhere")";
  CHECK(warns_of(import_text(lacking.text()), "no modifier 'nowhere'"));
}

TEST_CASE("each type of modifier becomes the material that Radiance would show") {
  HbjsonRoom room;
  room.modifiers =
      R"({"type":"Metal","identifier":"metal","r_reflectance":0.5,"g_reflectance":0.5,"b_reflectance":0.5},
         {"type":"Trans","identifier":"trans","r_reflectance":0.8,"g_reflectance":0.8,"b_reflectance":0.8,
          "transmitted_diff":0.5,"transmitted_spec":0},
         {"type":"Mirror","identifier":"mirror","r_reflectance":0.7,"g_reflectance":0.7,"b_reflectance":0.7},
         {"type":"Light","identifier":"light","r_emittance":3,"g_emittance":2,"b_emittance":1},
         {"type":"BSDF","identifier":"klems","thickness":0,"up_orientation":[0,0,1],"bsdf_data":")";
  std::string xml = klems_file({{"Transmission Front", peaked_matrix(klems_quarter(), 0.2, 0.4)}},
                               "LBNL/Klems Quarter");
  for (size_t at = 0; (at = xml.find_first_of("\"\n", at)) != std::string::npos; at += 2)
    xml.replace(at, 1, xml[at] == '"' ? "\\\"" : "\\n");
  room.modifiers += xml + "\"},";
  const auto shown = [&](const std::string& name) {
    room.window = "\"modifier\":\"" + name + "\"";
    return import_text(room.text());
  };
  CHECK(double(material_named(shown("metal"), "metal").metallic.value) == doctest::Approx(0.9));
  const Scene trans = shown("trans");
  CHECK(double(material_named(trans, "trans").diffuse_transmission.value) == doctest::Approx(0.5));
  CHECK(material_named(shown("mirror"), "mirror").is_reflectance);
  const Scene light = shown("light");
  REQUIRE(light.lights.size() == 1);
  CHECK(light.lights[0].radiance == Rgb{3, 2, 1});
  CHECK(light.lights[0].name == "window");
  // The corners' order gives the side that shines, which is the outside: y < 0.
  const Mesh& m = light.meshes.at(light.lights[0].geometry);
  CHECK(area_vector(m, m.triangles.at(0)).y < 0);
  const Scene scene = shown("klems");
  const Material& klems = material_named(scene, "klems");
  CHECK(klems.kind == MaterialKind::angular);
  CHECK(klems.angular->to_front.in.size() == 41);
  CHECK(look_of(scene, "klems").normal.y == doctest::Approx(2));  // front: the inside
}

TEST_CASE("dynamic groups show the state that is asked for, and name the others") {
  HbjsonRoom room;
  room.modifiers =
      R"({"type":"Plastic","identifier":"blind","r_reflectance":0.3,"g_reflectance":0.3,"b_reflectance":0.3},)";
  room.window =
      R"("dynamic_group_identifier":"South","states":[{"type":"RadianceSubFaceStateAbridged"},
         {"modifier":"blind","shades":[{"identifier":"slat","geometry":{"boundary":
           [[1,-1,1],[3,-1,1],[3,-1,1.5],[1,-1,1.5]]}}]}])";
  const Scene open = import_text(room.text());
  REQUIRE(open.dynamic_groups.size() == 1);
  CHECK(open.dynamic_groups[0].name == "South");
  CHECK(open.dynamic_groups[0].states == std::vector<std::string>{"state 0", "blind"});
  CHECK(look_of(open, "generic_exterior_window_vis_0.64").area == doctest::Approx(2));
  CHECK(look_of(open, "generic_exterior_shade_0.35").area == 0);
  const Scene closed = import_text(room.text(), {{"South", 1}});
  CHECK(closed.dynamic_groups[0].shown == 1);
  CHECK(look_of(closed, "blind").area == doctest::Approx(2));
  CHECK(look_of(closed, "generic_exterior_shade_0.35").area == doctest::Approx(1));
  CHECK(open.dynamic_groups[0].has_windows);
  CHECK_THROWS_AS(import_text(room.text(), {{"South", 2}}), UsageError);
  CHECK_THROWS_AS(import_text(room.text(), {{"North", 0}}), UsageError);
}

TEST_CASE("a blocked group has a black window and no shades of states") {
  HbjsonRoom room;
  room.window =
      R"("dynamic_group_identifier":"South","states":[{"shades":[{"identifier":"slat",
         "geometry":{"boundary":[[1,-1,1],[3,-1,1],[3,-1,1.5],[1,-1,1.5]]}}]}])";
  const TempFolder folder;
  ImportOptions options;
  options.blocked_groups = {"South"};
  const Scene scene = import_scene(folder.write("m.hbjson", room.text()), options);
  CHECK(look_of(scene, "generic_exterior_window_vis_0.64").area == 0);
  CHECK(look_of(scene, "generic_exterior_shade_0.35").area == 0);
  CHECK(look_of(scene, "troffer black window").area == doctest::Approx(2));
  const Material& black = material_named(scene, "troffer black window");
  CHECK(black.base_color.value.is_black());
  CHECK(black.diffuse_transmission.value == 0);
}

TEST_CASE("a group without states has one state") {
  HbjsonRoom room;
  room.window = R"("dynamic_group_identifier":"South")";
  const Scene scene = import_text(room.text());
  REQUIRE(scene.dynamic_groups.size() == 1);
  CHECK(scene.dynamic_groups[0].states.size() == 1);
  CHECK(look_of(scene, "generic_exterior_window_vis_0.64").area == doctest::Approx(2));
  CHECK_THROWS_AS(import_text(room.text(), {{"South", 1}}), UsageError);
}

// A wall of 6 m² with a window of 1 m², a door of 2 m² on its lower edge, an L-shaped opening of
// 0.75 m², and one of which a half, 0.5 m², lies outside.
TEST_CASE("openings are cut out where they touch, overlap and leave the face") {
  const Corners wall{{0, 0, 0}, {3, 0, 0}, {3, 0, 2}, {0, 0, 2}};
  const auto area = [](const std::vector<Corners>& pieces) {
    Vec3d sum;
    for (const Corners& p : pieces)
      for (size_t i = 1; i + 1 < p.size(); ++i) sum += cross(p[i] - p[0], p[i + 1] - p[0]) * 0.5;
    return -sum.y;
  };
  const Corners window{{0.2, 0, 0.5}, {1.2, 0, 0.5}, {1.2, 0, 1.5}, {0.2, 0, 1.5}};
  const Corners door{{1.5, 0, 0}, {2.5, 0, 0}, {2.5, 0, 1.8}, {1.5, 0, 1.8}};
  const Corners l_shape{{0, 0, 0},      {1, 0, 0},     {1, 0, 0.25},
                        {0.5, 0, 0.25}, {0.5, 0, 0.4}, {0, 0, 0.4}};
  const Corners leaving{{2.7, 0, 1}, {3.3, 0, 1}, {3.3, 0, 1.5}, {2.7, 0, 1.5}};
  CHECK(area({wall}) == doctest::Approx(6));
  CHECK(area(without_openings(wall, {window})) == doctest::Approx(5));
  CHECK(area(without_openings(wall, {window, window})) == doctest::Approx(5));
  CHECK(area(without_openings(wall, {door})) == doctest::Approx(6 - 1.8));
  CHECK(area(without_openings(wall, {l_shape})) == doctest::Approx(6 - 0.25 - 0.075));
  CHECK(area(without_openings(wall, {leaving})) == doctest::Approx(6 - 0.15));
  CHECK(area(without_openings(wall, {window, door, l_shape, leaving})) ==
        doctest::Approx(6 - 1 - 1.8 - 0.325 - 0.15));
  CHECK(without_openings(wall, {wall}).empty());
  const Corners turned(window.rbegin(), window.rend());
  CHECK(area(without_openings(wall, {turned})) == doctest::Approx(5));
}

// The second face between two rooms is moved into its room by twice the tolerance, and has no
// window of its own [honeybee-radiance, writer.py].
TEST_CASE("of two faces between rooms the second is moved and has no glass") {
  const auto room = [](const std::string& id, const std::string& other, bool is_turned) {
    const std::string corners =
        is_turned ? "[[0,0,0],[0,1,0],[0,1,1],[0,0,1]]" : "[[0,0,0],[0,0,1],[0,1,1],[0,1,0]]";
    const std::string glass = "[[0,0.2,0.2],[0,0.2,0.8],[0,0.8,0.8],[0,0.8,0.2]]";
    return R"({"type":"Room","identifier":"room_)" + id + R"(","faces":[{"identifier":")" + id +
           R"(","face_type":"Wall","geometry":{"boundary":)" + corners +
           R"(},"boundary_condition":{"type":"Surface","boundary_condition_objects":[")" + other +
           R"(","room"]},"apertures":[{"identifier":"g","geometry":{"boundary":)" + glass +
           R"(},"boundary_condition":{"type":"Surface"}}]}]})";
  };
  const Scene scene =
      import_text(R"({"type":"Model","tolerance":0.01,"rooms":[)" + room("a", "b", false) + "," +
                  room("b", "a", true) + R"(],"properties":{"radiance":{}}})");
  CHECK(look_of(scene, "generic_interior_window_vis_0.88").area == doctest::Approx(0.36));
  CHECK(look_of(scene, "generic_wall_0.50").area == doctest::Approx(2 * 0.64));
  // The first gives x = 0, the second, which looks along -x from x > 0, gives x = 0.02.
  const Boxd box = bounds_in_file(scene);
  CHECK(std::max(std::abs(box.lower.x), std::abs(box.upper.x)) == doctest::Approx(0.02));
}

TEST_CASE("what is not read is named") {
  HbjsonRoom room;
  room.model = "\"elevators\":[1],";
  room.radiance = "\"luminaires\":[{}],";
  room.modifiers = R"({"type":"Velvet","identifier":"v"},)";
  const Scene scene = import_text(room.text());
  CHECK(warns_of(scene, "'elevators' is not read"));
  CHECK(warns_of(scene, "'luminaires' is not read"));
  CHECK(warns_of(scene, "modifier type \"Velvet\""));
}

TEST_CASE("broken models are refused with their place") {
  const std::string good = HbjsonRoom().text();
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    text.replace(at, from.size(), to);
    return error_of(text);
  };
  CHECK(error_of(good.substr(0, 500)).find("not valid JSON") != std::string::npos);
  CHECK(error_of("{\"type\":\"Room\"}").find("is not a Honeybee model") != std::string::npos);
  CHECK(error_of("[1]").find("is not a Honeybee model") != std::string::npos);
  CHECK(changed("[0,0,0]", "[0,0]").find("should have 3 numbers, has 2") != std::string::npos);
  CHECK(changed("[0,0,0]", "[0,0,\"a\"]").find("should be a number") != std::string::npos);
  CHECK(changed("\"dir\":[0,0,2]", "\"dir\":[0,0,0]").find("has no direction") !=
        std::string::npos);
  CHECK(changed("\"faces\":[", "\"faces\":{\"a\":[").find("m.hbjson:1:") != std::string::npos);
  CHECK(changed("\"view_type\":\"a\"", "\"view_type\":\"x\"").find("is not one of") !=
        std::string::npos);
  const std::string place = changed("[0,0,0]", "[0,0]");
  CHECK(place.find("/rooms/0/faces/0/geometry/boundary/0") != std::string::npos);
}

TEST_CASE("four hundred mutated models are read or refused") {
  HbjsonRoom room;
  room.window = R"("dynamic_group_identifier":"g","states":[{"modifier":"a"},{"modifier":"b"}])";
  room.modifiers =
      R"({"type":"Glass","identifier":"a","r_transmissivity":0.5},{"type":"Trans","identifier":"b"},)";
  check_mutations(room.text(), 400, [](const std::string& text) { import_text(text); });
}

}  // namespace test_hbjson
