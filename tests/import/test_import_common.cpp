// Tests of what all importers share: files, paths, URIs, positions in JSON texts, textures, the
// choice of format.
#include <doctest/doctest.h>

#include <array>
#include <cstring>

#include "base/error.h"
#include "image/exr_fixture.h"
#include "import/file.h"
#include "import/halve_texture.h"
#include "import/import.h"
#include "import/json_location.h"
#include "import/temp_folder.h"
#include "import/texture_loader.h"
#include "import/uri.h"

using namespace troffer;

namespace test_import_common {

namespace {

std::string text_of(const std::vector<uint8_t>& bytes) {
  return {bytes.begin(), bytes.end()};
}

// Returns two pixels of rgb floats, little-endian.
std::string pfm() {
  const std::array<float, 6> texels{1, 0, 0, 0, 0, 1};
  std::string bytes(sizeof texels, '\0');
  std::memcpy(bytes.data(), texels.data(), sizeof texels);
  return "PF\n2 1\n-1.0\n" + bytes;
}

std::string reason_of_import(const std::string& path) {
  try {
    import_scene(path);
  } catch (const InputError& e) {
    CHECK(e.file() == path);
    return e.reason();
  }
  return "no error";
}

}  // namespace

TEST_CASE("files: whole contents, and clear reasons where there are none") {
  const TempFolder folder;
  const std::string path = folder.write("a.txt", std::string("x\0y", 3));
  CHECK(read_text_file(path) == std::string("x\0y", 3));
  CHECK(read_file(path).size() == 3);
  CHECK(read_file(folder.write("empty", "")).empty());
  CHECK_THROWS_AS(read_file(path, 2), InputError);
  CHECK_THROWS_AS(read_file(folder.path("nothing")), InputError);
  CHECK_THROWS_AS(read_file(folder.path("")), InputError);
  CHECK_THROWS_AS(read_file("/dev/zero"), InputError);
  CHECK_THROWS_AS(read_file(""), InputError);
  CHECK(folder_of("a/b/c.x") == "a/b");
  CHECK(folder_of("c.x") == ".");
  CHECK(lower_case_ending("a.b/c.GlTf") == "gltf");
  CHECK(lower_case_ending("a.b/c") == "");
}

TEST_CASE("confined paths stay inside their folder") {
  const TempFolder folder;
  folder.write("room/in/a.png", "x");
  folder.write("roommate/b.png", "x");
  std::filesystem::create_directory_symlink(folder.path("roommate"), folder.path("room/out"));
  std::filesystem::create_directory_symlink(folder.path("room/in"), folder.path("room/again"));
  const std::string room = folder.path("room");
  for (const char* const name : {"in/a.png", "./in//a.png", "in/../in/a.png", "nothing.png",
                                 "again/a.png", "a b.png", "..a.png", "in/..b"}) {
    CAPTURE(name);
    CHECK(confined_path(room, name).is_fine());
  }
  for (const char* const name : {"", "..", "../roommate/b.png", "in/../../roommate/b.png",
                                 "out/b.png", "out/new.png", "/etc/passwd", "../room/in/a.png"}) {
    CAPTURE(name);
    CHECK_FALSE(confined_path(room, name).is_fine());
  }
  CHECK_FALSE(confined_path(room, std::string_view("in\0/a", 5)).is_fine());
  CHECK(read_text_file(confined_path(room, "in/a.png").path) == "x");
  // The folder itself may be reached through a link.
  std::filesystem::create_directory_symlink(room, folder.path("link"));
  CHECK(confined_path(folder.path("link"), "in/a.png").is_fine());
}

TEST_CASE("percent-decoding and base64") {
  CHECK(percent_decoded("a%20b%C3%A9") == "a b\xc3\xa9");
  CHECK(percent_decoded("") == "");
  for (const char* const bad : {"%", "%4", "%4g", "a%"}) CHECK_FALSE(percent_decoded(bad));
  const std::array<std::pair<const char*, const char*>, 7> known{
      {{"", ""},
       {"Zg==", "f"},
       {"Zm8=", "fo"},
       {"Zm9v", "foo"},
       {"Zm9vYg==", "foob"},
       {"Zm9vYmE=", "fooba"},
       {"Zm9vYmFy", "foobar"}}};  // RFC 4648, section 10
  for (const auto& [encoded, plain] : known) {
    REQUIRE(base64_decoded(encoded));
    CHECK(text_of(*base64_decoded(encoded)) == plain);
    std::string bare = encoded;
    while (bare.ends_with('=')) bare.pop_back();
    CHECK(text_of(*base64_decoded(bare)) == plain);
  }
  for (const char* const bad : {"Z", "Zg=", "Zm9=v", "Zm 9v", "=", "====", "Zm9v="})
    CHECK_FALSE(base64_decoded(bad));
  CHECK(text_of(parse_data_uri("data:,a%20b")->bytes) == "a b");
  CHECK(parse_data_uri("DATA:image/PNG;x=y;base64,Zg%3D%3D")->media_type == "image/png");
  CHECK_FALSE(parse_data_uri("data:base64"));
  CHECK_FALSE(parse_data_uri("file.bin"));
  CHECK(has_uri_scheme("http://x"));
  CHECK(has_uri_scheme("data:,"));
  CHECK_FALSE(has_uri_scheme("a/b:c"));
  CHECK_FALSE(has_uri_scheme("file.bin"));
}

TEST_CASE("JSON pointers are resolved to line and column") {
  const std::string text =
      "{\n"
      "  \"a\": [10, {\"b/c\": \"x\\\"]}\"},\n"
      "    -3.5e7],\n"
      "  \"k\\u0065y\": {\"~\": [[], {}, true]},\n"
      "  \"a2\": null\n"
      "}";
  const auto at = [&](const char* pointer) {
    const TextPosition p = position_of_json_value(text, pointer);
    return std::pair{p.line, p.column};
  };
  CHECK(at("") == std::pair{1, 1});
  CHECK(at("/a") == std::pair{2, 8});
  CHECK(at("/a/0") == std::pair{2, 9});
  CHECK(at("/a/1/b~1c") == std::pair{2, 21});
  CHECK(at("/a/2") == std::pair{3, 5});
  CHECK(at("/key/~0/2") == std::pair{4, 30});
  CHECK(at("/a2") == std::pair{5, 9});
  CHECK(at("/a/9") == std::pair{2, 8});  // the innermost existing value
  CHECK(at("/nothing/3") == std::pair{1, 1});
  // The last of equal keys counts, and broken texts do no harm.
  CHECK(position_of_json_value("{\"a\":1,\n\"a\":2}", "/a").line == 2);
  for (size_t n = 0; n <= text.size(); ++n)
    for (const char* const pointer : {"/a/1/b~1c", "/key/~0/2", "/x"})
      CHECK(position_of_json_value(text.substr(0, n), pointer).line <= 6);
}

TEST_CASE("textures are shared by equal requests and decoded once") {
  const TempFolder folder;
  const std::string path = folder.write("a.pfm", pfm());
  Scene scene;
  TextureLoader loader(scene);
  Texture look;
  const int32_t first = loader.from_file(path, look);
  CHECK(loader.from_file(path, look) == first);
  look.wrap_u = WrapMode::clamp;
  const int32_t second = loader.from_file(path, look);
  CHECK(second != first);
  REQUIRE(scene.textures.size() == 2);
  CHECK(scene.textures[0].texels_float == scene.textures[1].texels_float);
  CHECK(scene.textures[0].width == 2);
  CHECK(scene.textures[1].wrap_u == WrapMode::clamp);
  CHECK(scene.textures[0].name == path);
  // A decoded file is not read again.
  std::filesystem::remove(path);
  look.is_filtered = false;
  loader.from_file(path, look);
  CHECK(scene.textures[2].kind == TextureKind::image);
  CHECK(scene.warnings.entries().empty());
}

TEST_CASE("colours of EXR images are converted to sRGB, data are not") {
  test::ExrFixture fixture{.width = 1, .height = 1, .constants = {0.5f, 0.5f, 0.5f}};
  fixture.chromaticities = {0.713f, 0.293f, 0.165f, 0.830f, 0.128f, 0.044f, 0.32168f, 0.33767f};
  const auto value = [&](bool is_color) {
    Scene scene;
    TextureLoader loader(scene);
    Texture look;
    look.is_srgb = is_color;
    const std::vector<uint8_t> bytes = test::make_exr(fixture);
    const int32_t index = loader.from_memory(bytes, "a.exr", look);
    return evaluate(scene.textures, uint32_t(index), Vec2{0.5f, 0.5f}).rgb;
  };
  for (size_t c = 0; c < 3; ++c) CHECK(value(true)[c] == doctest::Approx(0.5).epsilon(1e-4));
  fixture.constants = {0, 1, 0};  // a green outside sRGB
  CHECK(value(true).r == 0);
  CHECK(value(true).g > 1.1f);
  CHECK(value(false) == Rgb{0, 1, 0});
}

TEST_CASE("missing images become constant textures with warnings: grey for colours") {
  const TempFolder folder;
  Scene scene;
  TextureLoader loader(scene);
  const std::vector<uint8_t> junk{1, 2, 3};
  for (const int32_t i :
       {loader.from_file(folder.path("nothing.png"), {}), loader.from_memory(junk, "junk", {}),
        loader.from_memory({}, "empty", {}), loader.from_file(folder.path(""), {})}) {
    REQUIRE(i >= 0);
    CHECK(scene.textures[size_t(i)].kind == TextureKind::constant);
    CHECK(scene.textures[size_t(i)].value == Rgb{0.5f});
  }
  CHECK(scene.warnings.total() == 4);
  Texture data;
  data.is_srgb = false;
  CHECK(scene.textures[size_t(loader.from_memory(junk, "data", data))].value == Rgb{1});
}

TEST_CASE("the format is chosen by the ending, in any case") {
  const TempFolder folder;
  const std::string reason = reason_of_import(folder.write("scene.blend", "x"));
  for (const char* const ending : {".gltf", ".glb", ".pbrt", ".obj"})
    CHECK(reason.find(ending) != std::string::npos);
  for (const std::string ending : {"gltf", "glb", "pbrt", "obj", "GLTF", "Obj"}) {
    CAPTURE(ending);
    CHECK(reason_of_import(folder.path("nothing." + ending)).find("no such file") !=
          std::string::npos);
    std::filesystem::create_directories(folder.path("folder." + ending));
    CHECK(reason_of_import(folder.path("folder." + ending)).find("folder") != std::string::npos);
    CHECK(reason_of_import(folder.write("empty." + ending, "")) == "is empty");
  }
  CHECK(import_scene(folder.write("a.GLTF", "{\"asset\":{\"version\":\"2.0\"}}")).meshes.empty());
}

TEST_CASE("halving an image averages linear light instead of bytes; alpha is averaged directly") {
  Texture t;
  t.kind = TextureKind::image;
  t.width = 2;
  t.height = 1;
  t.channels = 4;
  t.texels8 = {0, 255, 10, 0, 255, 255, 10, 255};
  const Texture h = halved(t);
  CHECK(h.width == 1);
  CHECK(h.height == 1);
  CHECK(int(h.texels8.at(0)) == 188);  // half the light of white
  CHECK(int(h.texels8[1]) == 255);
  CHECK(int(h.texels8[2]) == 10);
  CHECK(int(h.texels8[3]) == 128);
  Texture odd;
  odd.kind = TextureKind::image;
  odd.width = 3;
  odd.height = odd.channels = 1;
  odd.texels_float = {1, 3, 7};
  odd.wrap_u = WrapMode::mirror;
  const Texture small = halved(odd);
  CHECK(small.texels_float == std::vector<float>{2, 7});
  CHECK(small.wrap_u == WrapMode::mirror);
  CHECK(halved(halved(small)).texels_float == std::vector<float>{4.5f});
}

TEST_CASE("images that do not fit into memory together are reduced, down to one texel") {
  const TempFolder folder;
  const std::string first = folder.write("a.pfm", pfm()), second = folder.write("b.pfm", pfm());
  Scene scene;
  TextureLoader loader(scene, 30);  // one image takes 24 bytes
  const auto a = size_t(loader.from_file(first, {})), b = size_t(loader.from_file(second, {}));
  CHECK(scene.textures.at(a).width == 2);
  CHECK(scene.warnings.total() == 1);
  CHECK(scene.textures.at(b).width == 1);
  CHECK(scene.textures[b].texels_float == std::vector<float>{0.5f, 0, 0.5f});
}

}  // namespace test_import_common
