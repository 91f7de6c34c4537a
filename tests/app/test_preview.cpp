// Pictures during the rendering (--preview).
#include <doctest/doctest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "app/commands.h"
#include "image/read_image.h"
#include "image/write_image.h"
#include "program.h"

using namespace troffer;
using namespace troffer::test;

namespace test_preview {

namespace {

float mean(const Image& image) {
  double sum = 0;
  for (const Rgb& p : image.pixels) sum += double(luminance(p));
  return float(sum / double(image.pixels.size()));
}

double share_of_black(const Image& image) {
  const auto n = std::count_if(image.pixels.begin(), image.pixels.end(),
                               [](const Rgb& p) { return p.is_black(); });
  return double(n) / double(image.pixels.size());
}

}  // namespace

TEST_CASE("a complete preview exists after two seconds of work, by every method") {
  for (const std::string method : {"certified", "path", "fixed"}) {
    CAPTURE(method);
    const Folder folder;
    const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
    REQUIRE(run_program(folder, {"render", scene, "-o", folder.path("whole.exr"), "--method",
                                 method, "--quiet"})
                .status == 0);
    const Image whole = read_image(folder.path("whole.exr"));
    Running program(
        folder, {"render", scene, "-o", folder.path("o.exr"), "-o", folder.path("o.pfm"), "--spp",
                 "1000000", "--method", method, "--threads", "1", "--preview", "--quiet"});
    program.let_work(2);
    // The file is complete at any moment.
    const std::filesystem::path copy = folder.path("copy.exr");
    std::filesystem::copy_file(folder.path("o.exr"), copy);
    const Image image = read_image(copy.string());
    CHECK(read_image(folder.path("o.pfm")).width == whole.width);
    program.send(SIGTERM);
    CHECK(program.wait().status == 130);
    CHECK(image.width == whole.width);
    CHECK(image.height == whole.height);
    CHECK(mean(image) == doctest::Approx(mean(whole)).epsilon(0.1));
    CHECK(share_of_black(image) < share_of_black(whole) + 0.05);
  }
}

TEST_CASE("after a preview the picture is the same, byte for byte") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  for (const std::string method : {"certified", "kj92", "path"}) {
    CAPTURE(method);
    std::vector<std::string> plain{"render",   scene,
                                   "-o",       folder.path("a.exr"),
                                   "-o",       folder.path("a.png"),
                                   "--method", method,
                                   "--aov",    "normal",
                                   "--quiet"};
    std::vector<std::string> shown = plain;
    shown[3] = folder.path("b.exr");
    shown[5] = folder.path("b.png");
    shown.insert(shown.end(), {"--preview", "--crop", "0,0,40,30", "--threads", "3"});
    plain.insert(plain.end(), {"--crop", "0,0,40,30"});
    REQUIRE(run_program(folder, plain).status == 0);
    REQUIRE(run_program(folder, shown).status == 0);
    CHECK(read_file(folder.path("a.exr")) == read_file(folder.path("b.exr")));
    CHECK(read_file(folder.path("a.png")) == read_file(folder.path("b.png")));
    CHECK(folder.names() ==
          std::vector<std::string>{"a.exr", "a.png", "b.exr", "b.png", "room.pbrt"});
  }
}

TEST_CASE("a failure after a preview leaves no preview and no single output of several") {
  if (access("/dev/full", W_OK) != 0) return;
  for (const bool is_first : {true, false}) {
    const Folder folder;
    const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
    std::filesystem::create_symlink("/dev/full", folder.path("full.exr"));
    std::vector<std::string> outputs{folder.path("full.exr"), folder.path("o.png")};
    if (!is_first) std::swap(outputs[0], outputs[1]);
    const Finished f = run_program(
        folder, {"render", scene, "-o", outputs[0], "-o", outputs[1], "--preview", "--quiet"});
    CHECK(f.status == 1);
    CHECK(!std::filesystem::exists(folder.path("o.png")));  // outputs are written together or not
                                                            // at all
  }
}

TEST_CASE("a preview is written before images are read and does not change the result") {
  const Folder folder;
  write_image(folder.path("t.png"), Image(64, 64, Rgb{0.2f, 0.4f, 0.6f}));
  const std::string scene = folder.write(
      "room.pbrt", std::string(lit_floor_pbrt) +
                       "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"t.png\"\n"
                       "Material \"diffuse\" \"texture reflectance\" \"t\"\n"
                       "Shape \"sphere\" \"float radius\" 0.2\n");
  const auto has_image = [](const Scene& s) {
    return std::any_of(s.textures.begin(), s.textures.end(),
                       [](const Texture& t) { return t.kind == TextureKind::image; });
  };
  int shown = 0;
  const ShowShapes show = [&](const Scene& shapes) {
    ++shown;
    CHECK(!has_image(shapes));
    CHECK(triangle_count(shapes) + shapes.spheres.size() > 1);
  };
  SceneChoice choice;
  choice.file = scene;
  UpUse up;
  CHECK(has_image(load_scene(choice, {}, nullptr, true, up, show)));
  CHECK(shown == 1);
  choice.file = folder.write("plain.pbrt", lit_floor_pbrt);
  CHECK(!load_scene(choice, {}, nullptr, true, up, show).skipped_image_bytes);
  CHECK(shown == 1);  // nothing was left out

  const std::vector<std::string> plain{
      "render", scene, "-o", folder.path("a.pfm"), "--method", "path", "--spp", "4", "--quiet"};
  std::vector<std::string> previewed = plain;
  previewed[3] = folder.path("b.pfm");
  previewed.push_back("--preview");
  REQUIRE(run_program(folder, plain).status == 0);
  REQUIRE(run_program(folder, previewed).status == 0);
  CHECK(read_file(folder.path("a.pfm")) == read_file(folder.path("b.pfm")));
}

}  // namespace test_preview
