#include "render/first_sight.h"

#include <doctest/doctest.h>

#include <cmath>

#include "base/random.h"
#include "render/preview.h"
#include "trace/tracer.h"

using namespace troffer;

namespace {

void add_triangle(Mesh& m, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto base = uint32_t(m.positions.size());
  m.positions.insert(m.positions.end(), {a, b, c});
  m.triangles.push_back({base, base + 1, base + 2});
}

// Large walls, also behind the camera and across its plane, and triangles smaller than pixels.
Scene walls_and_crumbs() {
  Scene s;
  s.materials.resize(1);
  Mesh m;
  add_triangle(m, {-9, -2, 9}, {-9, -2, -9}, {9, -2, -9});
  add_triangle(m, {-9, -2, 9}, {9, -2, -9}, {9, -2, 9});
  add_triangle(m, {-3, -2, -6}, {3, -2, -6}, {3, 5, -6});
  add_triangle(m, {-1, -1, 8}, {1, -1, 8}, {0, 1, 8});
  Random r(5);
  for (int i = 0; i < 40000; ++i) {
    const Vec3 c{r.next_float() * 2 - 2, r.next_float() * 2 - 1, -4 - 0.2f * r.next_float()};
    add_triangle(m, c, c + Vec3{0.02f, 0, 0}, c + Vec3{0, 0.02f, 0});
  }
  s.meshes.push_back(m);
  return s;
}

}  // namespace

TEST_CASE(
    "a first sight shows where rays hit and how surfaces are tilted, for any number of threads") {
  const Scene scene = walls_and_crumbs();
  const Camera camera = look_at({0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 60);
  const ViewingCamera viewing(camera, 96, 72);
  const PixelRect window{0, 0, 96, 72};
  const Image image = first_sight(scene, viewing, window, 3);
  const Tracer tracer(scene);
  int wrong = 0, off = 0, hits = 0;
  for (int y = 0; y < 72; ++y)
    for (int x = 0; x < 96; ++x) {
      const Ray ray = viewing.ray({float(x) + 0.5f, float(y) + 0.5f}, {0.5f, 0.5f});
      Hit hit;
      tracer.closest({&ray, 1}, {&hit, 1});
      const float value = image.at(x, y).g;
      if ((value > 0) != hit.is_valid()) {
        ++wrong;
        continue;
      }
      if (!hit.is_valid()) continue;
      ++hits;
      const Triangle& t = scene.meshes[0].triangles[hit.primitive];
      const auto& p = scene.meshes[0].positions;
      const Vec3 n = normalize(cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]));
      if (std::abs(value - (0.05f + 0.35f * std::abs(dot(n, ray.direction)))) > 0.01f) ++off;
    }
  CHECK(hits > 3000);
  CHECK(wrong < 150);  // pixels partly covered by crumbs
  CHECK(off < 150);
  CHECK(image.pixels == first_sight(scene, viewing, window, 1).pixels);
  // A crop equals its part of the picture.
  const Image part = first_sight(scene, viewing, {20, 10, 52, 40}, 2);
  int differ = 0;
  for (int y = 0; y < part.height; ++y)
    for (int x = 0; x < part.width; ++x)
      differ += part.at(x, y) == image.at(20 + x, 10 + y) ? 0 : 1;
  CHECK(differ == 0);
}

TEST_CASE("a preview shows a first sight only of scenes that are large or wait for images") {
  for (const bool waits : {false, true})
    for (const size_t triangles : {size_t{1000}, size_t{200'001}}) {
      Scene scene = walls_and_crumbs();
      Mesh& m = scene.meshes[0];
      m.triangles.resize(triangles, m.triangles[2]);
      RenderOptions options;
      options.width = 64;
      options.height = 48;
      std::vector<Image> shown;
      Preview preview([&](const Image& image) { shown.push_back(image); });
      preview.sight(scene, look_at({0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 60), options, waits);
      REQUIRE(shown.size() == (waits || triangles > 200'000 ? 1 : 0));
      if (shown.empty()) continue;
      CHECK(shown[0].width == 64);
      CHECK(shown[0].at(40, 24).g > 0.3f);  // the wall ahead
    }
}
