// A default sky lights pictures of dark scenes, but never verdicts or measured values.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include "program.h"

using namespace troffer;
using namespace troffer::test;

namespace test_no_light {

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != text.npos;
}

// A room of 4 × 3 × 4 m with a window, whose only lamp emits `strength`.
std::string room(double strength) {
  return fmt::format(
      "WorldBegin\nMaterial \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n"
      "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3]\n"
      "  \"point3 P\" [0 0 0  4 0 0  4 3 0  0 3 0]\n"
      "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [{0} {0} {0}]\n"
      "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3]\n"
      "  \"point3 P\" [1 1 2.5  1 2 2.5  2 2 2.5  2 1 2.5]\nAttributeEnd\n",
      strength);
}

const char* const bare_obj = "v 0 0 0\nv 4 0 0\nv 4 3 0\nv 0 3 0\nf 1 2 3 4\n";
const char* const dark_gltf = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],
"nodes":[{"mesh":0,"name":"floor"},{"name":"lamp","translation":[1,2,1],
"extensions":{"KHR_lights_punctual":{"light":0}}}],
"extensionsUsed":["KHR_lights_punctual"],
"extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","intensity":0}]}},
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,0,1]}],
"bufferViews":[{"buffer":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAAAAAAAAAAAAAIA/AACAPwAAAAAAAAAA"}]})";

struct DarkTest {
  Folder folder;
  std::string points = folder.write("p.csv", "x,y,z,nx,ny,nz\n.2,.2,.2,0,0,1\n");
  std::string lamp = folder.write(
      "lamp.ies", "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 5\n0 90\n0\n100 100\n");

  Finished measure(const std::string& scene, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"measure", scene, "--points", points,
                                   "--spp",   "16",  "--up",     "0,0,1"};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(folder, words);
  }
};

void check_refused(const Finished& f) {
  CAPTURE(f.err);
  CHECK(f.status == 1);
  CHECK(f.out.empty());
  CHECK(contains(f.err, "no light shines in it"));
  CHECK(contains(f.err, "--sky"));
}

}  // namespace

TEST_CASE("measure, report and bake refuse scenes without light and say what to do") {
  DarkTest t;
  for (const std::string& scene :
       {t.folder.write("bare.obj", bare_obj), t.folder.write("dark.pbrt", room(0)),
        t.folder.write("dark.gltf", dark_gltf)}) {
    CAPTURE(scene);
    check_refused(t.measure(scene));
    check_refused(run_program(t.folder, {"report", scene, "-o", t.folder.path("r"), "--up", "0,0,1",
                                         "--pictures", "off"}));
    check_refused(run_program(t.folder, {"bake", scene, "-o", t.folder.path("b.gltf")}));
  }
  CHECK(t.folder.names() ==
        std::vector<std::string>{"bare.obj", "dark.gltf", "dark.pbrt", "lamp.ies", "p.csv"});
}

TEST_CASE("lights that are dimmed to zero, or selected but dark, do not count as light") {
  DarkTest t;
  const std::string lit = t.folder.write("lit.pbrt", room(5)),
                    bare = t.folder.write("bare.obj", bare_obj);
  CHECK(t.measure(lit).status == 0);
  check_refused(t.measure(lit, {"--dim", "emitter0=0"}));
  check_refused(t.measure(lit, {"--dim", "*=0"}));
  const std::string list =
      t.folder.write("list.csv", "file,x,y,z,dimming\nlamp.ies,1,1,2,0\nlamp.ies,2,1,2,0\n");
  check_refused(t.measure(bare, {"--luminaires", list}));
  check_refused(
      t.measure(lit, {"--sky", "overcast", "--light", "emitter0", "--dim", "emitter0=0"}));
}

TEST_CASE("requested darkness is measured") {
  DarkTest t;
  const std::string bare = t.folder.write("bare.obj", bare_obj);
  for (const std::vector<std::string>& asked :
       {std::vector<std::string>{"--sky", "none"}, {"--at", "48,16,2026-06-21T23:00Z"}}) {
    const Finished f = t.measure(bare, asked);
    CAPTURE(f.err);
    REQUIRE(f.status == 0);
    CHECK(measured(f)[0].lx == 0);
    CHECK(contains(f.err, "there is no light"));
  }
  // A uniform sky is available by name.
  const Finished even = t.measure(bare, {"--sky", "even,10000"});
  REQUIRE(even.status == 0);
  CHECK(measured(even)[0].lx == doctest::Approx(10'000).epsilon(5e-3));
}

TEST_CASE("the power of luminaires has no effect on their light") {
  DarkTest t;
  const std::string lit = t.folder.write("lit.pbrt", room(5));
  const Finished f = run_program(
      t.folder, {"report", lit, "-o", t.folder.path("r"), "--up", "0,0,1", "--pictures", "off",
                 "--cylindrical", "off", "--spp", "16", "--power", "emitter0=0"});
  CAPTURE(f.err);
  CHECK(f.status == 0);
}

}  // namespace test_no_light
