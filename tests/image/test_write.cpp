// Files survive a round trip, equal pixels give equal bytes, and failures leave no files.
#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "base/error.h"
#include "image/atomic_file.h"
#include "image/fixtures.h"
#include "image/read_image.h"
#include "image/rgbe.h"
#include "image/write_image.h"

using namespace troffer;
using test::random_image;
using test::TemporaryFolder;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

std::string why_not_written(const std::string& path) {
  try {
    write_image(path, Image(2, 2));
  } catch (const EnvironmentError& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE("EXR and PFM preserve every bit") {
  const TemporaryFolder folder;
  Image image = random_image(37, 21, 1);
  image.at(0, 0) = {-1, infinity, 1e-42f};
  image.at(36, 20) = {3e38f, 0, -0.0f};
  for (const char* name : {"a.exr", "a.pfm", "A.EXR"}) {
    write_image(folder.path(name), image);
    const Image back = read_image(folder.path(name));
    CHECK(back.width == 37);
    CHECK(back.height == 21);
    CHECK(back.pixels == image.pixels);
  }
  image.at(3, 4) = Rgb{std::nanf("")};
  write_image(folder.path("nan.exr"), image);
  CHECK(std::isnan(read_image(folder.path("nan.exr")).at(3, 4).g));
}

TEST_CASE("HDR is exact to half a step of its largest component") {
  const TemporaryFolder folder;
  for (const int width : {5, 8, 300}) {  // plain pixels, shortest line with runs, long runs
    Image image = random_image(width, 9, 2);
    for (int x = 0; x < width; ++x) image.at(x, 3) = Rgb{0.5f};
    for (int x = width / 3; x < width; ++x) image.at(x, 4) = Rgb{1e-3f, 7, 1e5f};
    for (int x = 0; x < width; ++x) image.at(x, 5) = Rgb{float(x / 2), float(x / 3), 1};
    write_image(folder.path("a.hdr"), image);
    const Image back = read_image(folder.path("a.hdr"));
    for (size_t i = 0; i < image.pixels.size(); ++i) {
      const float step = max_component(image.pixels[i]) / 128;
      for (size_t c = 0; c < 3; ++c)
        CHECK(std::abs(back.pixels[i][c] - image.pixels[i][c]) <= 0.5f * step);
    }
    write_image(folder.path("b.hdr"), back);  // repacking changes nothing
    CHECK(read_file_bytes(folder.path("a.hdr")) == read_file_bytes(folder.path("b.hdr")));
  }
}

TEST_CASE("RGBE at the edges of its range") {
  using Bytes = std::array<uint8_t, 4>;
  CHECK(rgbe_from_rgb(Rgb{0}) == Bytes{0, 0, 0, 0});
  CHECK(rgbe_from_rgb(Rgb{-1, std::nanf(""), 0}) == Bytes{0, 0, 0, 0});
  CHECK(rgbe_from_rgb(Rgb{1, 0.5f, 0}) == Bytes{128, 64, 0, 129});
  CHECK(rgbe_from_rgb(Rgb{infinity, 0, 0}) == Bytes{255, 0, 0, 255});
  CHECK(rgbe_from_rgb(Rgb{std::nextafter(1.0f, 0.0f)}) == Bytes{255, 255, 255, 128});
  for (float v = 1e-30f; v < 1e37f; v *= 1.7f)
    CHECK(rgb_from_rgbe(rgbe_from_rgb(Rgb{v})).r == doctest::Approx(v).epsilon(0.004));
}

TEST_CASE("PNG holds the display values") {
  const TemporaryFolder folder;
  Image image(256, 1);
  for (int x = 0; x < 256; ++x) {
    const float linear = linear_from_srgb(float(x) / 255);
    image.at(x, 0) = {linear, 2 * linear, -1};
  }
  WriteOptions plain;
  plain.display.tone_map = ToneMap::none;
  write_image(folder.path("a.png"), image, plain);
  const Raster raster = decode_raster(read_file_bytes(folder.path("a.png")), "a.png");
  CHECK(raster.channels == 3);
  for (size_t x = 0; x < 256; ++x) {
    CHECK(raster.texels8[3 * x] == x);
    CHECK(raster.texels8[3 * x + 2] == 0);
  }
  CHECK(raster.texels8[3 * 255 + 1] == 255);
  write_image(folder.path("b.png"), image);  // filmic tone map
  CHECK(read_file_bytes(folder.path("a.png")) != read_file_bytes(folder.path("b.png")));
}

TEST_CASE("the same pixels give the same bytes, for any number of threads") {
  const TemporaryFolder folder;
  const Image image = random_image(64, 64, 3);
  for (const std::string ending : {".exr", ".hdr", ".pfm", ".png"}) {
    WriteOptions options;
    options.threads = 1;
    write_image(folder.path("a" + ending), image, options);
    options.threads = 3;
    write_image(folder.path("b" + ending), image, options);
    CHECK(read_file_bytes(folder.path("a" + ending)) == read_file_bytes(folder.path("b" + ending)));
  }
}

TEST_CASE("failed writes state the reason and leave nothing behind") {
  const TemporaryFolder folder;
  CHECK(why_not_written(folder.path("none/a.exr")) ==
        "cannot write " + folder.path("none/a.exr") + ": No such file or directory");
  std::filesystem::create_directory(folder.path("dir.png"));
  CHECK(why_not_written(folder.path("dir.png")).find("Is a directory") != std::string::npos);
  CHECK(folder.entries() == 1);
  CHECK_THROWS_AS(write_image(folder.path("a.tif"), Image(1, 1)), UsageError);
  CHECK_THROWS_AS(write_image(folder.path("png"), Image(1, 1)), UsageError);
  CHECK_THROWS_AS(write_image("", Image(1, 1)), UsageError);
  CHECK(folder.entries() == 1);
}

TEST_CASE("a full disk is reported") {
  if (!std::filesystem::exists("/dev/full")) return;
  const TemporaryFolder folder;
  std::filesystem::create_symlink("/dev/full", folder.path("full.png"));
  CHECK(why_not_written(folder.path("full.png")).find("No space left") != std::string::npos);
  CHECK(std::filesystem::is_symlink(folder.path("full.png")));
}

TEST_CASE("AtomicFile replaces files only as a whole") {
  const TemporaryFolder folder;
  const std::string path = folder.path("a.csv");
  const auto text = [&] {
    const auto bytes = read_file_bytes(path);
    return std::string(bytes.begin(), bytes.end());
  };
  write_file(path, "first");
  CHECK(text() == "first");
  {
    AtomicFile abandoned(path);
    abandoned.write("sec");
    CHECK(folder.entries() == 2);
  }
  CHECK(text() == "first");
  CHECK(folder.entries() == 1);
  AtomicFile one(path), two(path);  // two concurrent writers do not collide
  one.write("one");
  two.write("two");
  two.commit();
  CHECK(text() == "two");
  one.commit();
  CHECK(text() == "one");
  CHECK(folder.entries() == 1);

  std::filesystem::create_symlink("a.csv", folder.path("link.csv"));
  write_file(folder.path("link.csv"), "through");
  CHECK(std::filesystem::is_symlink(folder.path("link.csv")));
  CHECK(text() == "through");
  std::filesystem::permissions(
      path, std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  write_file(path, "private");
  CHECK((std::filesystem::status(path).permissions() & std::filesystem::perms::others_read) ==
        std::filesystem::perms::none);
  CHECK_NOTHROW(write_file("/dev/null", "x"));
  CHECK(std::filesystem::is_character_file("/dev/null"));
  CHECK_NOTHROW(OutputReservation(folder.path("new.csv")));
  CHECK_FALSE(std::filesystem::exists(folder.path("new.csv")));
  CHECK_THROWS_AS(OutputReservation(folder.path("no/new.csv")), EnvironmentError);
  CHECK_THROWS_AS(OutputReservation(""), EnvironmentError);
}

TEST_CASE("reading a missing file is an input error") {
  const TemporaryFolder folder;
  CHECK_THROWS_AS(read_image(folder.path("none.exr")), InputError);
  CHECK_THROWS_AS(read_image(folder.path("")), InputError);
  write_file(folder.path("long"), std::string(1000, 'x'));
  CHECK_THROWS_AS(read_file_bytes(folder.path("long"), 999), InputError);
  CHECK(read_file_bytes(folder.path("long"), 1000).size() == 1000);
}
