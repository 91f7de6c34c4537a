// Light from behind a lip: the radiance that a ray sees there depends on where it comes from.
#include <doctest/doctest.h>

#include <cmath>

#include "render/pictures.h"
#include "support/scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// A room lit by a strip in a trough along one wall, with a slit of 3 cm below the ceiling.
Scene cove_room() {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.7f});
  add_box_inside(s, grey, {0, 0, 0}, {4, 5, 2.8f});
  add_box_inside(s, grey, {0, 0, 2.5f}, {0.2f, 5, 2.52f});
  add_box_inside(s, grey, {0.2f, 0, 2.5f}, {0.21f, 5, 2.77f});
  make_light(s,
             add_quad(s, add_diffuse(s, Rgb{0}),
                      {Vec3{0.05f, 0.1f, 2.53f},
                       {0.1f, 0.1f, 2.53f},
                       {0.1f, 4.9f, 2.53f},
                       {0.05f, 4.9f, 2.53f}}),
             Rgb{100});
  return s;
}

constexpr int width = 64, height = 48, block = 16;

// Returns the root mean square difference over blocks of pixels.
double off_in_blocks(const Image& image, const Image& truth) {
  double squares = 0;
  int blocks = 0;
  for (int y = 0; y < height; y += block)
    for (int x = 0; x < width; x += block, ++blocks) {
      double of_image = 0, of_truth = 0;
      for (int i = 0; i < block * block; ++i) {
        of_image += double(luminance(image.at(x + i % block, y + i / block)));
        of_truth += double(luminance(truth.at(x + i % block, y + i / block)));
      }
      squares += sqr(of_image / of_truth - 1);
    }
  return std::sqrt(squares / blocks);
}

}  // namespace

TEST_CASE("light from a cove agrees with paths in all parts of a room") {
  const PreparedScene scene(cove_room());
  const Camera camera = look_at({0.5f, 0.5f, 1.5f}, {3.2f, 4.2f, 0.9f}, {0, 0, 1}, 75);
  RenderOptions path;
  path.method = Method::path;
  path.spp = path.max_spp = 512;
  const Image truth = reflected_light(scene, camera, width, height, path);
  RenderOptions ours;
  ours.error = 0.05;
  double squares = 0;
  for (const uint64_t seed : {1, 2, 3}) {
    ours.seed = seed;
    const double off = off_in_blocks(reflected_light(scene, camera, width, height, ours), truth);
    CAPTURE(off);
    CHECK(off < 0.13);
    squares += sqr(off) / 3;
  }
  // .14 to .17 with cells of full size; .03 for independent paths
  CHECK(std::sqrt(squares) < 0.09);
}

namespace {

// A hall whose ceiling is lit by strips that shine upwards, 5 cm above the shelves behind two lips.
Scene hall_with_coves() {
  Scene s;
  const uint32_t white = add_diffuse(s, Rgb{0.8f}), black = add_diffuse(s, Rgb{0});
  add_box_inside(s, white, {0, 0, 0}, {12, 6, 4});
  for (const float side : {0.0f, 1.0f}) {
    const auto y = [&](float from_wall) { return side > 0 ? 6 - from_wall : from_wall; };
    const auto box = [&](float from, float to, float z0, float z1) {
      add_box_inside(s, white, {0, std::min(y(from), y(to)), z0},
                     {12, std::max(y(from), y(to)), z1});
    };
    box(0, 0.5f, 3.4f, 3.45f);
    box(0.46f, 0.5f, 3.45f, 3.6f);
    const float middle = y(0.25f);
    make_light(s,
               add_quad(s, black,
                        {Vec3{0.6f, middle - 0.03f, 3.5f},
                         {11.4f, middle - 0.03f, 3.5f},
                         {11.4f, middle + 0.03f, 3.5f},
                         {0.6f, middle + 0.03f, 3.5f}}),
               Rgb{220});
  }
  return s;
}

}  // namespace

// The rim is narrower than a pixel, and its light comes from the shelf below, a part of which the
// lamp hides.
TEST_CASE("the bright strip above a cove's lip gets its light within three percent") {
  const PreparedScene scene(hall_with_coves());
  const Camera camera = look_at({1, 1, 1.6f}, {7, 4, 1.8f}, {0, 0, 1}, 75);
  const auto rim = [&](RenderOptions o) {
    o.has_crop = true;
    o.crop = {16, 0, 32, 32};
    return reflected_light(scene, camera, 128, 96, o);
  };
  RenderOptions path;
  path.method = Method::path;
  path.spp = path.max_spp = 2048;
  const Image truth = rim(path);
  const double typical = mean(truth);
  for (const uint64_t seed : {1, 2}) {
    RenderOptions ours;
    ours.error = 0.02;
    ours.seed = seed;
    const Image made = rim(ours);
    double of_made = 0, of_truth = 0;
    size_t pixels = 0;
    for (size_t i = 0; i < truth.pixels.size(); ++i) {
      if (double(luminance(truth.pixels[i])) < 2 * typical) continue;
      ++pixels;
      of_made += double(luminance(made.pixels[i]));
      of_truth += double(luminance(truth.pixels[i]));
    }
    CAPTURE(pixels);
    REQUIRE(pixels > 30);
    // .93 with fits on one side only and cells as wide as the shelf.
    CHECK(of_made / of_truth == doctest::Approx(1).epsilon(0.03));
  }
}
