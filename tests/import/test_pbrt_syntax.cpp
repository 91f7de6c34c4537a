// Tests of pbrt's syntax: tokens, parameters, blocks, includes, and positions of errors.
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "base/error.h"
#include "base/random.h"
#include "import/pbrt/pbrt.h"
#include "import/pbrt/pbrt_params.h"
#include "import/pbrt/pbrt_tokens.h"
#include "scene_checks.h"
#include "temp_folder.h"

using namespace troffer;

namespace test_pbrt_syntax {

namespace {

Scene import_text(const std::string& text) {
  const TempFolder folder;
  return import_pbrt(folder.write("scene.pbrt", text));
}

struct Failure {
  int line = -1, column = -1;
  std::string what;
};
Failure failure_of(const std::string& text) {
  try {
    import_text(text);
  } catch (const InputError& e) {
    return {e.line(), e.column(), e.reason()};
  }
  return {};
}

const std::string triangle = "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]\n";

}  // namespace

TEST_CASE("pbrt tokens carry their kind, text and place") {
  const std::string text =
      "Shape# comment \"x\"\n  \"a \\\"b\\\"\" [1 -.5e1 +2.] true\r\n1e400 \t-1e-400 nan";
  PbrtTokenizer tokens("f", text);
  PbrtToken t = tokens.next();
  CHECK(t.kind == PbrtTokenKind::word);
  CHECK(t.text == "Shape");
  t = tokens.next();
  CHECK(t.kind == PbrtTokenKind::string);
  CHECK(unescaped(t.text) == "a \"b\"");
  CHECK(t.line == 2);
  CHECK(t.column == 3);
  CHECK(tokens.next().kind == PbrtTokenKind::open_bracket);
  CHECK(tokens.next().number == 1);
  CHECK(tokens.next().number == -5);
  CHECK(tokens.peek().number == 2);
  CHECK(tokens.next().number == 2);
  CHECK(tokens.next().kind == PbrtTokenKind::close_bracket);
  CHECK(tokens.next().text == "true");
  t = tokens.next();
  CHECK(t.line == 3);
  CHECK(t.column == 1);
  CHECK(std::isinf(t.number));
  t = tokens.next();
  CHECK(t.number == 0);
  CHECK(t.column == 8);
  CHECK(std::isnan(tokens.next().number));
  CHECK(tokens.next().kind == PbrtTokenKind::end);
  CHECK(tokens.next().kind == PbrtTokenKind::end);
}

TEST_CASE("pbrt escapes") {
  CHECK(unescaped("a\\n\\t\\\\\\'\\\"b") == "a\n\t\\'\"b");
}

TEST_CASE("all number formats and old list syntax are read") {
  const Scene scene = import_text(
      "Film \"rgb\" \"integer xresolution\" 640 \"integer yresolution\" [ 480 ]\n"
      "Camera \"perspective\" \"float fov\" [9e1]\nWorldBegin\n"
      "Material \"diffuse\" \"rgb reflectance\" [.5 +.25 1.E-1]\n"
      "Shape \"trianglemesh\" \"point P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 2]");
  CHECK(scene.cameras.at(0).width == 640);
  CHECK(scene.cameras.at(0).half_extent == doctest::Approx(1));
  CHECK(scene.materials.at(0).base_color.value == Rgb(0.5f, 0.25f, 0.1f));
  CHECK(triangle_count(scene) == 1);
  CHECK(scene.warnings.entries().empty());
}

TEST_CASE("errors of pbrt files name the line and column of what is wrong") {
  struct Row {
    const char* text;
    int line, column;
    const char* what;
  };
  const std::vector<Row> rows{
      {"WorldBegin\n  Shap \"sphere\"", 2, 3, "unknown directive"},
      {"WorldBegin\nShape \"sphere\" \"float radius\" [1", 2, 31, "without ']'"},
      {"WorldBegin\nShape \"sphere", 2, 7, "closing quote"},
      {"WorldBegin\nShape \"sphere\" \"float radius\" [1 x]", 2, 34, "not a value"},
      {"WorldBegin\nShape \"sphere\" \"float radius\" []", 2, 16, "one value"},
      {"WorldBegin\nShape \"sphere\" \"float radius\" \"2\"", 2, 31, "not a value"},
      {"WorldBegin\nShape \"sphere\" \"string radius\" \"2\"", 2, 16, "of type float"},
      {"WorldBegin\nShape \"sphere\" \"float radius\" 1e999", 2, 16, "not finite"},
      {"WorldBegin\nShape \"sphere\" \"radius\" 1", 2, 16, "type name"},
      {"WorldBegin\nShape \"sphere\" \"flot radius\" 1", 2, 16, "unknown parameter type"},
      {"WorldBegin\nMaterial \"matte\" \"color Kd\" [1 1 1]", 2, 18, "pbrt-v3"},
      {"WorldBegin\nTranslate 1 2", 2, 14, "needs 3 numbers"},
      {"WorldBegin\nTranslate 1 2-3 4", 2, 13, "not a number"},
      {"WorldBegin\nScale 1 inf 1", 2, 9, "not finite"},
      {"WorldBegin\nTransform [1 0 0 0 0 1 0 0 0 0 1 1 0 0 0 1]", 2, 1, "projective"},
      {"LookAt 0 0 0 0 0 1 0 0 1\nWorldBegin", 1, 1, "up vector"},
      {"WorldBegin\nAttributeEnd", 2, 1, "without its beginning"},
      {"WorldBegin\nAttributeBegin\nObjectBegin \"a\"\nAttributeEnd", 4, 1, "beginning"},
      {"WorldBegin\n\n AttributeBegin", 3, 2, "without AttributeEnd"},
      {"WorldBegin\nObjectBegin \"a\"\nObjectBegin \"b\"", 3, 1, "within an object"},
      {"WorldBegin\nObjectBegin \"a\"\nObjectInstance \"a\"", 3, 1, "within an object"},
      {"WorldBegin\nObjectInstance \"a\"", 2, 1, "no object"},
      {"WorldBegin\nNamedMaterial \"m\"", 2, 15, "no material"},
      {"WorldBegin\nMakeNamedMaterial \"m\"", 2, 1, "string type"},
      {"WorldBegin\nTexture \"t\" \"color\" \"constant\"", 2, 13, "pbrt-v3"},
      {"WorldBegin\nWorldBegin", 2, 1, "before WorldBegin"},
      {"WorldBegin\nCamera \"perspective\"", 2, 1, "before WorldBegin"},
      {"Shape \"sphere\"", 1, 1, "after WorldBegin"},
      {"Camera \"perspective\" \"float fov\" 180\nWorldBegin", 1, 22, "fov"},
      {"Scale 0 1 1 Camera \"perspective\" WorldBegin", 1, 13, "no inverse"},
      {"Film \"rgb\" \"integer xresolution\" 0 WorldBegin", 1, 12, "xresolution"},
      {"WorldBegin\nShape \"trianglemesh\" \"point3 P\" [0 0 0 1]", 2, 22, "whole point3"},
      {"WorldBegin\nShape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0]", 2, 1, "indices"},
      {"WorldBegin\nShape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]\n"
       "\"integer indices\" [0 1 3]",
       3, 1, "out of range"},
      {"WorldBegin\nShape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]\n"
       "\"integer indices\" [0 1 -1]",
       3, 1, "out of range"},
      {"WorldBegin\nShape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]\n"
       "\"integer indices\" [0 1 1.5]",
       3, 24, "32-bit"},
      {"WorldBegin\nInclude \"none.pbrt\"", 2, 9, "no such file"},
      {"WorldBegin\nInclude \"../x.pbrt\"", 2, 9, "cannot use"},
      {"WorldBegin\nInclude \"/etc/passwd\"", 2, 9, "cannot use"},
      {"WorldBegin\nInclude \"scene.pbrt\"", 2, 9, "includes itself"},
      {"WorldBegin\nShape \"plymesh\" \"string filename\" \"../a.ply\"", 2, 17, "cannot use"},
      {"WorldBegin\n[", 2, 1, "expected a directive"},
      {"", 0, 0, "without WorldBegin"},
  };
  for (const Row& row : rows) {
    CAPTURE(row.text);
    const Failure failure = failure_of(row.text);
    CHECK(failure.line == row.line);
    CHECK(failure.column == row.column);
    CAPTURE(failure.what);
    CHECK(failure.what.find(row.what) != std::string::npos);
  }
}

TEST_CASE("unknown parameters and unsupported directives are warnings that name them") {
  const Scene scene = import_text(
      "Option \"bool forcediffuse\" true\nOption \"bool jiggle\" true\nColorSpace \"rec2021\"\n"
      "Option \"integer seed\" 4\nOption \"bool disabletexturefiltering\" false\n"
      "Sampler \"halton\" \"integer pixelsamples\" 4\n"
      "Camera \"perspective\" \"float fof\" 3\nMakeNamedMedium \"fog\" \"float scale\" "
      "1\nWorldBegin\n"
      "LightSource \"glow\" \"rgb I\" [1 1 1]\nLightSource \"glow\"\n"
      "Shape \"paraboloid\"\nShape \"sphere\" \"float raduis\" 2\n"
      "MediumInterface \"\" \"fog\"\nWorldEnd\n");
  for (const char* part : {"\"forcediffuse\" is not supported", "\"jiggle\" is unknown", "rec2021",
                           "Camera \"perspective\": parameter \"fof\"", "LightSource \"glow\"",
                           "shape \"paraboloid\"", "Shape \"sphere\": parameter \"raduis\"",
                           "MediumInterface", "MakeNamedMedium", "WorldEnd"}) {
    CAPTURE(part);
    CHECK(has_warning(scene, part));
  }
  CHECK_FALSE(has_warning(scene, "seed"));
  CHECK_FALSE(has_warning(scene, "disabletexturefiltering"));
  for (const Warning& w : scene.warnings.entries())
    if (w.text.find("glow") != std::string::npos) CHECK(w.count == 2);
  CHECK(scene.spheres.size() == 1);
}

TEST_CASE("included files share the state, imported ones give it back") {
  const TempFolder folder;
  folder.write("sub/move.pbrt", "Translate 10 0 0\nInclude \"sub/shape.pbrt\"\n");
  folder.write("sub/shape.pbrt", "Shape \"sphere\"\n");
  const Scene scene =
      import_pbrt(folder.write("scene.pbrt",
                               "WorldBegin Import \"sub/move.pbrt\" Shape \"sphere\" "
                               "Include \"sub/move.pbrt\" Shape \"sphere\" \"float radius\" 2"));
  REQUIRE(scene.spheres.size() == 4);
  CHECK(scene.spheres[0].centre == Vec3(10, 0, 0));
  CHECK(scene.spheres[1].centre == Vec3(0, 0, 0));
  CHECK(scene.spheres[3].centre == Vec3(10, 0, 0));
}

TEST_CASE("files that include each other end with an error") {
  const TempFolder folder;
  for (int i = 0; i < 40; ++i) {
    const std::string next = "f" + std::to_string(i + 1) + ".pbrt";
    folder.write("f" + std::to_string(i) + ".pbrt",
                 "Include \"" + next + "\"\nInclude \"" + next + "\"\n");
  }
  folder.write("f40.pbrt", "");
  CHECK_THROWS_AS(import_pbrt(folder.write("s.pbrt", "WorldBegin Include \"f0.pbrt\"")),
                  InputError);
}

TEST_CASE("Attribute sets defaults until the end of the block") {
  const Scene scene = import_text(
      "WorldBegin\nAttributeBegin\nAttribute \"shape\" \"float radius\" 3\n"
      "Attribute \"material\" \"rgb reflectance\" [1 0 0]\n"
      "Material \"diffuse\"\nShape \"sphere\"\nShape \"sphere\" \"float radius\" 2\n"
      "Attribute \"shape\" \"float radius\" 4\nShape \"sphere\"\n"
      "AttributeEnd\nShape \"sphere\"\n" +
      triangle);
  REQUIRE(scene.spheres.size() == 4);
  CHECK(scene.spheres[0].radius == 3);
  CHECK(scene.spheres[1].radius == 2);
  CHECK(scene.spheres[2].radius == 4);
  CHECK(scene.spheres[3].radius == 1);
  CHECK(scene.materials[scene.spheres[0].material].base_color.value == Rgb(1, 0, 0));
  CHECK(scene.warnings.entries().empty());
}

// Changes, drops or doubles bytes of a valid file. The result must load or throw InputError.
TEST_CASE("damaged pbrt files load or fail cleanly") {
  const std::string text =
      "LookAt 0 0 -5 0 0 0 0 1 0\nCamera \"perspective\" \"float fov\" [45]\n"
      "Film \"rgb\" \"integer xresolution\" [16] \"integer yresolution\" [9]\nWorldBegin\n"
      "Texture \"a\" \"float\" \"constant\" \"float value\" 0.5\n"
      "Texture \"b\" \"spectrum\" \"scale\" \"rgb tex\" [.1 .2 .3] \"texture scale\" \"a\"\n"
      "MakeNamedMaterial \"m\" \"string type\" \"coateddiffuse\" \"texture reflectance\" \"b\"\n"
      "AttributeBegin\nScale -1 2 1\nRotate 30 0 1 0\nAreaLightSource \"diffuse\" \"rgb L\" [1 2 "
      "3]\n"
      "Shape \"disk\" \"float radius\" [2]\nShape \"sphere\" \"float zmax\" .5\nAttributeEnd\n"
      "ObjectBegin \"o\"\nNamedMaterial \"m\"\nShape \"bilinearmesh\" \"point3 P\" "
      "[0 0 0 1 0 0 0 1 0 1 1 1]\nObjectEnd\nObjectInstance \"o\"\n" +
      triangle;
  const TempFolder folder;
  CHECK_NOTHROW(import_pbrt(folder.write("scene.pbrt", text)));
  Random random(7);
  size_t loads = 0, errors = 0;
  for (int round = 0; round < 1500; ++round) {
    std::string damaged = text;
    const int edits = 1 + int(random.next_u32() % 3);
    for (int e = 0; e < edits; ++e) {
      const size_t at = random.next_u32() % damaged.size();
      const size_t n = std::min<size_t>(1 + random.next_u32() % 8, damaged.size() - at);
      switch (random.next_u32() % 4) {
        case 0:
          damaged[at] = char(random.next_u32());
          break;
        case 1:
          damaged.erase(at, n);
          break;
        case 2:
          damaged.insert(at, damaged.substr(random.next_u32() % damaged.size(), n));
          break;
        default:
          damaged[at] = "0123456789-.e\"[] \n"[random.next_u32() % 18];
      }
      if (damaged.empty()) damaged = " ";
    }
    try {
      import_pbrt(folder.write("scene.pbrt", damaged));
      ++loads;
    } catch (const InputError&) {
      ++errors;
    }
  }
  CHECK(loads > 100);
  CHECK(errors > 100);
}

}  // namespace test_pbrt_syntax
