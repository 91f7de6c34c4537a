// Tests of a user's choices in a glTF file: a moment of an animation, a variant.
#include <algorithm>
#include <cmath>

#include "import/gltf_builder.h"

using namespace troffer;

namespace test_gltf_choices {

namespace {

// Returns the square moved by an animation of two samplers with keys at 1 s and 3 s. Accessors: 4
// keys, 5 translations, 6 rotations, 7 a cubic curve of translations.
std::string animated(const std::string& path, const std::string& output,
                     const std::string& interpolation, const std::string& node = "{'mesh':0}") {
  const float half = std::sqrt(0.5f);
  const std::string bytes = bytes_of<float>({1, 3}) + bytes_of<float>({0, 0, 0, 8, 0, 0}) +
                            bytes_of<float>({0, 0, 0, 1, 0, 0, half, half}) +
                            bytes_of<float>({0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 8, 0, 0, 0, 0, 0});
  std::string data = square_data();
  data.insert(data.find("],\n'bufferViews'"), "," + data_buffer(bytes));
  data.insert(data.find("],\n'accessors'"),
              ",{'buffer':1,'byteLength':8},{'buffer':1,'byteOffset':8,'byteLength':24},"
              "{'buffer':1,'byteOffset':32,'byteLength':32},"
              "{'buffer':1,'byteOffset':64,'byteLength':72}");
  data.insert(data.rfind(']'),
              ",{'bufferView':4,'componentType':5126,'count':2,'type':'SCALAR'},"
              "{'bufferView':5,'componentType':5126,'count':2,'type':'VEC3'},"
              "{'bufferView':6,'componentType':5126,'count':2,'type':'VEC4'},"
              "{'bufferView':7,'componentType':5126,'count':6,'type':'VEC3'}");
  return gltf_text(data +
                   ",'meshes':[{'primitives':[{'attributes':{'POSITION':0},'indices':1}]}],"
                   "'nodes':[" +
                   node +
                   "],'animations':[{'name':'walk','channels':[{'sampler':0,'target':{'node':0,"
                   "'path':'" +
                   path + "'}}],'samplers':[{'input':4,'output':" + output + ",'interpolation':'" +
                   interpolation + "'}]}]");
}

Scene at_time(const std::string& text, double time) {
  const TempFolder folder;
  ImportOptions options;
  options.time = time;
  return import_gltf(folder.write("scene.gltf", text), options);
}

}  // namespace

TEST_CASE("a moment of an animation: translations by steps, lines and curves") {
  const auto x_at = [](const char* output, const char* kind, double time) {
    return double(bounds(at_time(animated("translation", output, kind), time)).lower.x);
  };
  CHECK(x_at("5", "LINEAR", 0) == doctest::Approx(0));
  CHECK(x_at("5", "LINEAR", 1.5) == doctest::Approx(2));
  CHECK(x_at("5", "LINEAR", 9) == doctest::Approx(8));
  CHECK(x_at("5", "STEP", 2.99) == doctest::Approx(0));
  CHECK(x_at("5", "STEP", 3) == doctest::Approx(8));
  // Hermite: start 0 with tangent 1 over 2 s, end 8 with tangent 0.
  const double t = 0.25,
               expected = 2 * (t * t * t - 2 * t * t + t) + 8 * (3 * t * t - 2 * t * t * t);
  CHECK(x_at("7", "CUBICSPLINE", 1.5) == doctest::Approx(expected));
}

TEST_CASE("a moment of an animation: rotations stay on the sphere, and matrices are replaced") {
  // Half of a quarter turn around z puts the square's corner (1,1) above the origin.
  const Box box = bounds(at_time(animated("rotation", "6", "LINEAR"), 2));
  CHECK(box.upper.y == doctest::Approx(std::sqrt(2.0)));
  CHECK(box.lower.x == doctest::Approx(-std::sqrt(0.5)));
  const std::string node = "{'mesh':0,'matrix':[5,0,0,0,0,5,0,0,0,0,5,0,0,0,0,1]}";
  CHECK(bounds(at_time(animated("translation", "5", "LINEAR", node), 3)).upper.x ==
        doctest::Approx(9));
}

TEST_CASE("animations cause a warning unless one is requested; unknown names are refused") {
  const std::string text = animated("translation", "5", "LINEAR");
  CHECK(bounds(import_text(text)).lower.x == doctest::Approx(0));
  CHECK(has_warning(import_text(text), "--time"));
  const TempFolder folder;
  ImportOptions options;
  options.animation = "run";
  CHECK_THROWS_WITH_AS(import_gltf(folder.write("scene.gltf", text), options),
                       "--animation: there is no animation 'run', but walk", UsageError);
}

TEST_CASE("animation data that does not fit is refused where it stands") {
  const auto reason = [](const std::string& text) {
    try {
      at_time(text, 1);
    } catch (const InputError& e) {
      return e.reason();
    }
    return std::string("none");
  };
  CHECK(reason(animated("rotation", "5", "LINEAR")).find("4 components") != std::string::npos);
  CHECK(reason(animated("translation", "5", "CUBICSPLINE")).find("count") != std::string::npos);
  CHECK(reason(animated("translation", "4", "LINEAR")).find("3 components") != std::string::npos);
  CHECK(reason(animated("translation", "99", "LINEAR")).find("accessors") != std::string::npos);
  CHECK(reason(animated("translation", "5", "WAVY")).find("WAVY") != std::string::npos);
  CHECK(has_warning(at_time(animated("pointer", "5", "LINEAR"), 1),
                    "anything but properties of nodes"));
}

TEST_CASE("variants: the chosen one's materials, or a list of names") {
  std::string text = square_scene(
      "[{'mesh':0}]",
      "'extensionsUsed':['KHR_materials_variants'],'extensions':{'KHR_materials_variants':"
      "{'variants':[{'name':'oak'},{'name':'ash'}]}},'materials':[{'name':'plain'},"
      "{'name':'dark'}]");
  const std::string before = "\"material\":0";
  text.insert(text.find(before) + before.size(),
              ",\"extensions\":{\"KHR_materials_variants\":{\"mappings\":[{\"material\":1,"
              "\"variants\":[1]}]}}");
  const TempFolder folder;
  const std::string file = folder.write("scene.gltf", text);
  const auto name_with = [&](const std::optional<std::string>& variant) {
    ImportOptions options;
    options.variant = variant;
    const Scene scene = import_gltf(file, options);
    return scene.materials[scene.meshes.at(0).material].name;
  };
  CHECK(name_with(std::nullopt) == "plain");
  CHECK(name_with("oak") == "plain");
  CHECK(name_with("ash") == "dark");
  CHECK(has_warning(import_gltf(file), "oak, ash"));
  ImportOptions options;
  options.variant = "elm";
  CHECK_THROWS_WITH_AS(import_gltf(file, options),
                       "--variant: the scene has no variant 'elm', but oak, ash", UsageError);
}

}  // namespace test_gltf_choices
