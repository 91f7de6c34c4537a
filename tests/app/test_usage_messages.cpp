// Messages for mistyped command lines: what is wrong, and what to write.
#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "program.h"

using namespace troffer::test;

namespace test_usage_messages {

namespace {

struct Mistake {
  std::vector<std::string> words;
  std::string message;
};

void check_messages(const Folder& folder, const std::vector<Mistake>& mistakes, int status) {
  for (const Mistake& m : mistakes) {
    const Finished f = run_program(folder, m.words);
    CHECK(f.err == "error: " + m.message + "\n");
    CHECK(f.status == status);
    CHECK(f.out.empty());
  }
}

std::vector<std::string> render(const std::vector<std::string>& options) {
  std::vector<std::string> words{"render", "a.gltf", "-o", "a.exr"};
  words.insert(words.end(), options.begin(), options.end());
  return words;
}

// A camera, a lamp and a floor with names.
const char* const named_gltf = R"({"asset": {"version": "2.0"}, "scene": 0,
 "extensionsUsed": ["KHR_lights_punctual"],
 "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 100}]}},
 "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}],
 "scenes": [{"nodes": [0, 1, 2]}],
 "nodes": [{"name": "ceiling lamp", "translation": [0, 2, 0],
            "extensions": {"KHR_lights_punctual": {"light": 0}}},
           {"name": "entrance", "camera": 0, "translation": [0, 1, 3]},
           {"name": "desk", "mesh": 0}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                "min": [0, 0, 0], "max": [1, 0, 1]},
               {"bufferView": 1, "componentType": 5121, "count": 3, "type": "SCALAR"}],
 "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 3}],
 "buffers": [{"byteLength": 39, "uri":
 "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAAAAAAAAAAAAAIA/AACAPwAAAAAAAAAAAAEC"}]})";

}  // namespace

TEST_CASE("mistyped commands and options get a suggestion") {
  const Folder folder;
  check_messages(
      folder,
      {{{"rendr", "a.gltf"},
        "there is no command 'rendr'; did you mean 'render'? (troffer help lists the commands)"},
       {{"xyzzy"}, "there is no command 'xyzzy' (troffer help lists the commands)"},
       {{"--size", "3x3"},
        "a command must come first: troffer COMMAND … (troffer help lists the commands)"},
       {{"help", "mesure"},
        "there is no command 'mesure'; did you mean 'measure'? (troffer help lists the commands)"},
       {render({"--szie", "10x10"}),
        "render has no option --szie; did you mean --size? (troffer help render lists its "
        "options)"},
       {render({"--eror=.1"}),
        "render has no option --eror; did you mean --error? (troffer help render lists its "
        "options)"},
       {render({"-size", "10x10"}),
        "render has no option -size; did you mean --size? (troffer help render lists its "
        "options)"},
       {render({"--qqqq"}), "render has no option --qqqq (troffer help render lists its options)"},
       {render({"b.gltf"}),
        "render has no use for 'b.gltf' (troffer help render lists its options)"},
       {{"render", "a.gltf"}, "render needs -o FILE (troffer help render lists its options)"},
       {{"render", "-o", "a.exr"}, "render needs SCENE (troffer help render lists its options)"},
       {{"measure", "a.gltf"}, "measure: give --points FILE.csv or --grid NODE"},
       {{"compare", "a.exr"}, "compare needs REFERENCE (troffer help compare lists its options)"},
       {render({"--spp"}), "--spp needs a value: --spp N"},
       {render({"--spp", "4", "--spp"}), "--spp needs a value: --spp N"},
       {render({"--size", "8x8", "--size", "9x9"}),
        "--size is given more than once: choose one value"}},
      2);
}

TEST_CASE("messages about unreadable values say what to write") {
  const Folder folder;
  check_messages(
      folder,
      {{render({"--size", "100"}), "--size: '100' is not WIDTHxHEIGHT in pixels, such as 640x480"},
       {render({"--crop", "1,2,3"}),
        "--crop: '1,2,3' is not X0,Y0,X1,Y1 in pixels, such as 0,0,320,240"},
       {render({"--error", "0,01"}), "--error: '0,01' has a comma: write 0.01"},
       {render({"--fov", "60,5"}), "--fov: '60,5' has a comma: write 60.5"},
       {render({"--error", "small"}), "--error: 'small' is not a number"},
       {render({"--error", "nan"}), "--error: 'nan' is not a number"},
       {render({"--error", "2"}), "--error: 2 is too large: write a number from 0.000001 to 1"},
       {render({"--spp", "0"}), "--spp: 0 is too small: write a whole number of 1 or more"},
       {render({"--spp", "1e3"}), "--spp: '1e3' is not a whole number"},
       {render({"--depth", "1.5"}), "--depth: '1.5' is not a whole number"},
       {render({"--seed", "-1"}), "--seed: '-1' is below 0"},
       {render({"--threads", "x"}), "--threads: 'x' is not a whole number"},
       {render({"--tone-map", "fimlic"}),
        "--tone-map: there is no 'fimlic'; did you mean 'filmic'? (filmic or none)"},
       {render({"--coherence", "yes"}), "--coherence: there is no 'yes', but on or off"},
       {render({"--method", "certifed"}),
        "--method: there is no 'certifed'; did you mean 'certified'? (certified, kj92, fixed, "
        "path or cached-path)"},
       {render({"--indirect", "nothing"}),
        "--indirect: there is no 'nothing', but auto, cells, radiosity or none"},
       {{"radiosity", "a.gltf", "-o", "a.trad", "--element-size", "0,5"},
        "--element-size: '0,5' has a comma: write 0.5"},
       {{"radiosity", "a.gltf", "-o", "a.trad", "--patch-size", "0"},
        "--patch-size: '0' is not a number above 0"}},
      2);
}

TEST_CASE("unknown names get the nearest name of the scene as a suggestion") {
  const Folder folder;
  const std::string scene = folder.write("room.gltf", named_gltf), out = folder.path("o.exr");
  check_messages(
      folder,
      {{{"render", scene, "-o", out, "--light", "cieling lamp"},
        "no light is named 'cieling lamp'; did you mean 'ceiling lamp'? (troffer info lists them)"},
       {{"render", scene, "-o", out, "--camera", "entrace"},
        "no camera is named 'entrace'; did you mean 'entrance'? (troffer info lists them)"},
       {{"render", scene, "-o", out, "--camera", "x"},
        "no camera is named 'x' (troffer info lists them)"},
       {{"report", scene, "-o", folder.path("r"), "--surface", "dsek"},
        "--surface: nothing is named 'dsek'; did you mean 'desk'?"},
       {{"report", scene, "-o", folder.path("r"), "--power", "ceiling lam=30"},
        "--power: no luminaire is named 'ceiling lam'; did you mean 'ceiling lamp'?"},
       {{"render", scene, "-o", out, "--portal", "dsek"},
        "--portal: 'dsek' is neither twelve numbers nor the name of a flat rectangle; did you mean "
        "'desk'?"}},
      2);
}

TEST_CASE("missing or empty files are reported") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  const std::string wrong = folder.path("rom.pbrt");
  check_messages(
      folder,
      {{{"info", wrong}, wrong + ": no such file; did you mean 'room.pbrt'?"},
       {{"compare", folder.path("a.exr"), "b.exr"},
        folder.path("a.exr") + ": cannot open: no such file"},
       {{"measure", scene, "--points", folder.write("none.csv", "x,y,z,nx,ny,nz\n")},
        folder.path("none.csv") + ":1:1: lists no point"},
       {{"render", folder.write("empty.pbrt", "WorldBegin\n"), "-o", folder.path("o.exr"),
         "--quiet"},
        folder.path("empty.pbrt") + ":1:1: is empty: it has neither surfaces nor lights"},
       {{"render", folder.write("lamp.pbrt", "WorldBegin\nLightSource \"point\"\n"), "-o",
         folder.path("o.exr"), "--quiet"},
        folder.path("lamp.pbrt") + ":1:1: has nothing to show: no surface, sky or image"}},
      1);
  // A sky is visible.
  CHECK(run_program(folder,
                    {"render", folder.path("empty.pbrt"), "-o", folder.path("o.exr"), "--sky",
                     "even", "--size", "4x4", "--quiet", "--eye", "0,0,0", "--target", "1,0,0"})
            .status == 0);
}

TEST_CASE("layers for files that cannot hold them cause a warning") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  const auto err = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"render", scene,      "--size", "8x6",   "--spp",
                                   "1",      "--method", "fixed",  "--aov", "depth"};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(folder, words).remarks();
  };
  const std::string png = folder.path("o.png"), exr = folder.path("o.exr");
  CHECK(err({"-o", png, "--exposure", "0"}) ==
        "warning: --aov: " + png + " cannot hold layers; write an .exr file too\n");
  CHECK(err({"-o", png, "--exposure", "0", "--quiet"}) == "");
  CHECK(err({"-o", png, "-o", exr, "--exposure", "0"}) == "");
}

TEST_CASE("help lists the commands and the options of a command by groups") {
  const Folder folder;
  const Finished help = run_program(folder, {"help"}), bare = run_program(folder, {});
  CHECK(help.status == 0);
  CHECK(bare.status == 2);
  CHECK(bare.err == help.out);
  CHECK(run_program(folder, {"--help"}).out == help.out);
  for (const char* line : {"troffer renders rooms and measures their light.\n",
                           "\n  render     Render a picture of a scene\n",
                           "\n  measure    Measure irradiance and illuminance at points\n",
                           "\ntroffer help COMMAND lists the options of a command"})
    CHECK(help.out.find(line) != std::string::npos);

  const std::string options = run_program(folder, {"help", "render"}).out;
  CHECK(run_program(folder, {"render", "--help"}).out == options);
  size_t at = 0;  // groups come in this order
  for (const char* heading :
       {"Usage: troffer render SCENE -o FILE [options]\n", "\nInput:\n  SCENE ", "\nView:\n",
        "\nLight:\n", "\nQuality:\n", "\nOutput:\n  -o, --output FILE ", "\nLimits:\n",
        "\nMethod certified:\n", "\nMethod path:\n  --depth N", "\nMethod fixed:\n",
        "\nMethod kj92:\n  --variance ERROR "}) {
    CAPTURE(heading);
    const size_t found = options.find(heading, at);
    REQUIRE(found != std::string::npos);
    at = found;
  }
  CHECK(options.find("(1 or more) [4]") != std::string::npos);
  for (const std::string& line : [&] {
         std::vector<std::string> lines(1);
         for (const char c : options)
           if (c == '\n')
             lines.emplace_back();
           else
             lines.back() += c;
         return lines;
       }()) {
    CAPTURE(line);
    CHECK(line.size() <= 90);  // bytes; 80 columns
  }
}

TEST_CASE("every option of every command has a group and a value name") {
  const Folder folder;
  const auto help = nlohmann::json::parse(run_program(folder, {"help", "--json"}).out);
  REQUIRE(help["commands"].size() >= 10);
  for (const auto& command : help["commands"])
    for (const auto& group : command["groups"]) {
      CAPTURE(command["name"].get<std::string>());
      CAPTURE(group.dump());
      CHECK(group["name"] != "Other");  // if this fails, add the option to app/option_table.cpp
    }
}

}  // namespace test_usage_messages
