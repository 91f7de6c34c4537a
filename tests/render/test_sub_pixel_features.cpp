// The search for sub-pixel features finds those that are visible, and nothing else.
#include <doctest/doctest.h>

#include <algorithm>

#include "render/sub_pixel_features.h"
#include "support/scenes.h"
#include "support/stopwatch.h"

using namespace troffer;
using namespace troffer::test;

namespace {

constexpr int pixels_along = 32;
constexpr float far_away = 16;  // distance of the wall; a pixel is a metre wide there

// A camera that looks along y at 32 × 32 pixels.
ViewingCamera view_of_wall() {
  return {look_at({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 90), pixels_along, pixels_along};
}

// Returns the point at a raster position, at this distance along y.
Vec3 at(float x, float y, float distance) {
  const ViewingCamera c = view_of_wall();
  const Ray r = c.ray({x, y}, {0.5f, 0.5f});
  return r.origin + r.direction * (distance / r.direction.y);
}

// Adds a wall across the picture, in tiles of `each` pixels.
void add_wall(Scene& s, float each = pixels_along) {
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  Mesh mesh;
  mesh.material = grey;
  const int n = int(float(pixels_along) / each);
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      mesh.positions.push_back(at(float(i) * each, float(j) * each, far_away));
  const auto vertex = [&](int i, int j) { return uint32_t(j * (n + 1) + i); };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
    }
  s.meshes.push_back(mesh);
}

// Returns a triangle around the middle of a pixel.
Mesh leaf_at(float x, float y, float distance, float size = 0.2f) {
  Mesh mesh;
  mesh.positions = {at(x - size, y - size, distance), at(x + size, y - size, distance),
                    at(x, y + size, distance)};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

std::vector<Pixel2> found(const Scene& s) {
  const PreparedScene scene{Scene(s)};
  const PixelRect region{0, 0, pixels_along, pixels_along};
  const ViewingCamera c = view_of_wall();
  const PixelCorners corners(scene, c, region, 2);
  std::vector<uint8_t> has_edge;
  for (int y = 0; y < pixels_along; ++y)
    for (int x = 0; x < pixels_along; ++x) has_edge.push_back(corners.differ(x, y) ? 1 : 0);
  const std::vector<uint8_t> has =
      pixels_with_sub_pixel_features(scene, c, region, corners, has_edge, 2);
  std::vector<Pixel2> out;
  for (int y = 0; y < pixels_along; ++y)
    for (int x = 0; x < pixels_along; ++x)
      if (has[size_t(y * pixels_along + x)] != 0) out.push_back({x, y});
  return out;
}

}  // namespace

TEST_CASE("a leaf between the corners of a pixel is found, before a wall and before the sky") {
  for (const bool has_wall : {true, false}) {
    Scene s;
    if (has_wall) add_wall(s);
    if (!has_wall) add_diffuse(s, Rgb{0.5f});
    s.meshes.push_back(leaf_at(10.5f, 12.5f, 5));
    const std::vector<Pixel2> pixels = found(s);
    REQUIRE(pixels.size() == 1);
    CHECK(pixels[0].x == 10);
    CHECK(pixels[0].y == 12);
  }
}

TEST_CASE("features hidden by a wall are not found, nor the tiles of a wall") {
  Scene hidden;
  add_wall(hidden);
  hidden.meshes.push_back(leaf_at(10.5f, 12.5f, far_away + 1));
  CHECK(found(hidden).empty());
  Scene tiles;
  add_wall(tiles, 0.25f);
  CHECK(found(tiles).empty());
  // nor is a leaf behind another one in the same pixel
  Scene two;
  add_wall(two);
  two.meshes.push_back(leaf_at(10.5f, 12.5f, 5));
  two.meshes.push_back(leaf_at(10.5f, 12.5f, 6));
  CHECK(found(two).size() == 1);
}

TEST_CASE("a wire between rows of corners is found in every pixel that it runs through") {
  Scene s;
  add_wall(s);
  Mesh wire;
  wire.positions = {at(5.1f, 20.4f, 5), at(25.9f, 20.4f, 5), at(25.9f, 20.6f, 5),
                    at(5.1f, 20.6f, 5)};
  wire.triangles = {{0, 1, 2}, {0, 2, 3}};
  s.meshes.push_back(wire);
  const std::vector<Pixel2> pixels = found(s);
  CHECK(pixels.size() == 21);
  for (const Pixel2& p : pixels) CHECK(p.y == 20);
}

TEST_CASE("small spheres and disks are found; larger ones are found by the pixel corners instead") {
  Scene s;
  add_wall(s);
  const float metres = 5.0f / far_away;  // width of a pixel at that distance
  s.spheres.push_back({at(8.5f, 8.5f, 5), 0.3f * metres});
  Disk disk;
  disk.centre = at(20.5f, 9.5f, 5);
  disk.normal = {0, -1, 0};
  disk.radius = 0.3f * metres;
  s.disks.push_back(disk);
  s.spheres.push_back({at(16, 24, 5), 3 * metres});
  const std::vector<Pixel2> pixels = found(s);
  REQUIRE(pixels.size() == 2);
  CHECK((pixels[0].x == 8 && pixels[0].y == 8));
  CHECK((pixels[1].x == 20 && pixels[1].y == 9));
}

// Each wire extends ten thousand pixels beyond the picture on either side.
TEST_CASE("only the part of a long wire inside the picture takes time") {
  Scene s;
  add_wall(s);
  Mesh wires;
  for (uint32_t k = 0; k < 50'000; ++k) {
    const float y = 20.4f + 0.002f * float(k % 100);
    for (const Vec3& p : {at(-1e4f, y, 5), at(1e4f, y, 5), at(1e4f, y + 0.1f, 5)})
      wires.positions.push_back(p);
    wires.triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
  }
  s.meshes.push_back(wires);
  const ProcessorStopwatch watch;
  const std::vector<Pixel2> pixels = found(s);
  CHECK(watch.seconds() < 5);
  CHECK(pixels.size() == 32);
  for (const Pixel2& p : pixels) CHECK(p.y == 20);
}
