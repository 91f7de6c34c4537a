// All layers of an EXR file, with window and note.
#include "image/layered_image.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "base/error.h"

using namespace troffer;

namespace {

struct File {
  std::string path = (std::filesystem::temp_directory_path() /
                      ("troffer-layers-" + std::to_string(getpid()) + ".exr"))
                         .string();
  ~File() { std::remove(path.c_str()); }
};

Layer layer(const std::string& name, std::vector<std::string> channels, float value) {
  Layer l{name, std::move(channels), Image(5, 3, Rgb{value})};
  l.image.at(4, 2) = Rgb{value + 1, value + 2, value + 3};
  return l;
}

}  // namespace

TEST_CASE("layers, window and note come back as they were written") {
  const File file;
  const std::vector<Layer> layers{layer("", {"R", "G", "B"}, 1), layer("depth", {"Z"}, 7),
                                  layer("normal", {"X", "Y", "Z"}, 0.5f)};
  WriteOptions options;
  options.window = {10, 20, 64, 48};
  options.note = "part 1/3";
  write_image(file.path, layers, options);
  const LayeredImage read = read_layers(file.path);
  CHECK(read.note == options.note);
  CHECK(read.window.x == 10);
  CHECK(read.window.y == 20);
  CHECK(read.window.full_width == 64);
  CHECK(read.window.full_height == 48);
  REQUIRE(read.layers.size() == 3);
  for (size_t l = 0; l < 3; ++l) {
    CHECK(read.layers[l].name == layers[l].name);
    CHECK(read.layers[l].channels == layers[l].channels);
    const Rgb got = read.layers[l].image.at(4, 2), put = layers[l].image.at(4, 2);
    CHECK(got.r == put.r);
    if (layers[l].channels.size() == 3) CHECK(got == put);
  }
  options.note.clear();
  write_image(file.path, layers, options);
  CHECK(read_layers(file.path).note.empty());
  CHECK_THROWS_AS(read_layers(file.path, 5 * 3 * 3 - 1), InputError);
}

TEST_CASE("other files are refused") {
  const File file;
  CHECK_THROWS_AS(read_layers(file.path), InputError);
  std::ofstream(file.path, std::ios::binary) << "v/1\x01 and no more";
  CHECK_THROWS_AS(read_layers(file.path), InputError);
  const std::vector<Layer> only_depth{layer("depth", {"Z"}, 7)};
  write_image(file.path, only_depth);
  CHECK_THROWS_AS(read_layers(file.path), InputError);
}
