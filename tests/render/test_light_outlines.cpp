// Exact coverage of lamps in pixels, and pictures that use it.
#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "base/random.h"
#include "render/light_outlines.h"
#include "render/pictures.h"
#include "scene/mesh_in_world.h"
#include "support/light_scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace {

constexpr int side = 48;
constexpr PixelRect window{0, 0, side, side};

struct Lamps {
  Scene scene;
  uint32_t grey = add_diffuse(scene, Rgb{0.5f});
  Camera camera = look_at({0, 0, 3}, {0.2f, 0.1f, 0}, {0, 1, 0}, 40);

  uint32_t quad(float x, float y, float size, float z = 0) {
    return add_quad(scene, grey,
                    {Vec3{x, y, z},
                     {x + size, y + 0.1f * size, z},
                     {x + size, y + size, z},
                     {x - 0.2f * size, y + size, z}});
  }
  void wall() { add_quad(scene, grey, {Vec3{-9, -9, -1}, {9, -9, -1}, {9, 9, -1}, {-9, 9, -1}}); }
};

// Sums over places in a pixel: what rays see of lamps, and the corrected values.
struct Sums {
  double seen = 0, edge_correction = 0, evening = 0, squares = 0;
  int count = 0;
};

// Statistics of LightOutlines over a picture. For pixels with known coverage, corrected rays must
// have little variance and the same mean. Also the number of pixels that lamps touch, and how many
// of those are known.
struct Found {
  size_t touched = 0, unknown = 0, known = 0, missed = 0;
  // for radiance 1: over all pixels; in one pixel
  double bias = 0, most_bias = 0, most_variance = 0;
};
Found look(Lamps lamps, bool knows = true) {
  const PreparedScene scene(std::move(lamps.scene));
  const ViewingCamera camera(lamps.camera, side, side);
  const LightOutlines outlines(scene, camera, window, knows, 1);
  Found f;
  constexpr uint32_t n = 1024;
  std::vector<Ray> rays(n);
  std::vector<Vec2> places(n);
  std::vector<Hit> hits(n);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      for (uint32_t i = 0; i < n; ++i) {
        const SobolGroup random(hash_of(uint64_t(x), uint64_t(y)), 0, i);
        places[i] = random.get2(0);
        rays[i] = camera.ray(Vec2{float(x), float(y)} + places[i], random.get2(2));
      }
      scene.tracer.closest(rays, hits);
      Sums s;
      for (uint32_t i = 0; i < n; ++i) {
        Rgb seen;
        if (hits[i].is_valid()) {
          const uint32_t g = hits[i].geometry;
          if (!is_mesh(scene.scene, g))
            seen = Rgb{1};  // a disk or a sphere
          else if (const auto& lights = scene.scene.meshes[g].lights; !lights.empty())
            seen = scene.scene.lights[size_t(lights[hits[i].primitive])].radiance;
        }
        const double even = double(outlines.edge_correction(x, y, places[i], seen).g);
        s.seen += double(seen.g) / n;
        s.evening += even / n;
        s.squares += std::pow(double(seen.g) + even, 2) / n;
      }
      const bool is_partly = s.seen > 0.004 && s.seen < 0.996;
      f.touched += is_partly ? 1 : 0;
      f.missed += is_partly && !outlines.has_outline(x, y) ? 1 : 0;
      if (!outlines.has_outline(x, y)) {
        CHECK(s.evening == 0);
        continue;
      }
      f.known += outlines.is_known(x, y) ? 1 : 0;
      f.unknown += outlines.is_known(x, y) ? 0 : 1;
      f.bias += s.evening;
      f.most_bias = std::max(f.most_bias, std::abs(s.evening));
      if (outlines.is_known(x, y))
        f.most_variance = std::max(f.most_variance, s.squares - std::pow(s.seen + s.evening, 2));
    }
  return f;
}

}  // namespace

TEST_CASE("light outlines: what lamps of all shapes cover is exact in every pixel they touch") {
  std::vector<Lamps> all(6);
  for (int i = 0; i < 20; ++i)  // many small ones, several of them within one pixel
    make_light(all[0].scene,
               all[0].quad(-0.8f + 0.37f * float(i % 5), -0.7f + 0.41f * float(i / 5),
                           0.01f + 0.012f * float(i)),
               Rgb{1});
  make_light(all[1].scene, all[1].quad(-0.3f, -0.3f, 0.9f), Rgb{1});
  add_disk_light(all[2].scene, all[2].grey, {0.1f, 0.2f, 0}, normalize(Vec3{0.3f, 0.5f, 1}), 0.6f,
                 Rgb{1});
  add_sphere_light(all[3].scene, all[3].grey, {-0.2f, 0.1f, 0.4f}, 0.4f, Rgb{1});
  // A bent strip: two triangles with a common edge and one next to them.
  add_mesh_light(all[4].scene, all[4].grey,
                 {{-0.5f, -0.5f, 0},
                  {0.5f, -0.4f, 0.3f},
                  {0.4f, 0.5f, 0},
                  {-0.6f, 0.4f, 0.2f},
                  {0.9f, 0.1f, -0.2f}},
                 {{0, 1, 2}, {0, 2, 3}, {1, 4, 2}}, Rgb{1}, false);
  all[5] = all[1];
  all[5].camera.kind = CameraKind::orthographic;
  all[5].camera.half_extent = 1;
  for (Lamps& lamps : all) {
    CAPTURE(&lamps - all.data());
    lamps.wall();
    const Found f = look(lamps);
    CHECK(f.touched > 30);
    CHECK(f.missed == 0);
    CHECK(f.unknown == 0);
    CHECK(f.known >= f.touched);
    CHECK(f.most_bias < 0.01);  // of 1024 stratified places
    CHECK(std::abs(f.bias) < 5e-4 * double(f.known));
    CHECK(f.most_variance < 0.0015);  // up to .25 without correction
    const Found not_wanted = look(lamps, false);
    CHECK(not_wanted.known == 0);
    CHECK(not_wanted.unknown == f.known);
    CHECK(not_wanted.most_bias == 0);
  }
}

TEST_CASE("light outlines: sides that pieces share do not count twice, in large pictures too") {
  // A fan of 30 triangles within about one pixel of a large picture; another lamp touches it.
  Lamps lamps;
  constexpr int blades = 30;
  constexpr float radius = 0.0004f;
  std::vector<Vec3> positions{{0, 0, 0}};
  std::vector<Triangle> triangles;
  for (uint32_t i = 0; i < blades; ++i) {
    const float angle = 2 * 3.14159265f * float(i) / blades;
    positions.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
    triangles.push_back({0, 1 + i, 1 + (i + 1) % blades});
  }
  add_mesh_light(lamps.scene, lamps.grey, positions, triangles, Rgb{1}, false);
  add_quad(lamps.scene, lamps.grey,
           {Vec3{radius, -radius, 0},
            {3 * radius, -radius, 0},
            {3 * radius, radius, 0},
            {radius, radius, 0}});
  make_light(lamps.scene, 1, Rgb{1});
  const PreparedScene scene(std::move(lamps.scene));
  constexpr int pixels = 8192, middle = pixels / 2;
  const ViewingCamera camera(look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 40), pixels, pixels);
  const PixelRect region{middle - 8, middle - 8, middle + 8, middle + 8};
  const LightOutlines outlines(scene, camera, region, true, 2);
  size_t known = 0;
  double bias = 0;
  for (int y = region.y0; y < region.y1; ++y)
    for (int x = region.x0; x < region.x1; ++x) {
      if (!outlines.is_known(x, y)) continue;
      ++known;
      constexpr uint32_t n = 1 << 14;
      std::vector<Ray> rays(n);
      std::vector<Vec2> places(n);
      std::vector<Hit> hits(n);
      for (uint32_t i = 0; i < n; ++i) {
        places[i] = SobolGroup(hash_of(uint64_t(x), uint64_t(y)), 0, i).get2(0);
        rays[i] = camera.ray(Vec2{float(x), float(y)} + places[i], {0.5f, 0.5f});
      }
      scene.tracer.closest(rays, hits);
      double mean = 0;
      for (uint32_t i = 0; i < n; ++i)
        mean += double(
            outlines.edge_correction(x, y, places[i], Rgb{hits[i].is_valid() ? 1.0f : 0.0f}).g);
      CHECK(std::abs(mean / n) < 0.004);
      bias += mean / n;
    }
  CHECK(known >= 4);
  CHECK(std::abs(bias) < 0.001 * double(known));
}

TEST_CASE("light outlines: unknown for lamps that are partly hidden, textured or out of focus") {
  Lamps hidden;
  make_light(hidden.scene, hidden.quad(-0.4f, -0.4f, 0.8f), Rgb{1});
  Lamps before = hidden, lens = hidden, behind = hidden, away = hidden, textured = hidden;
  // A wire in front: coverage is unknown where it crosses the outline.
  add_quad(before.scene, before.grey, {Vec3{-2, 0, 1}, {2, 0, 1}, {2, 0.02f, 1}, {-2, 0.02f, 1}});
  const Found crossed = look(before), free = look(hidden);
  CHECK(free.unknown == 0);
  CHECK(crossed.unknown > 0);
  CHECK(crossed.unknown < 8);
  CHECK(crossed.known < free.known);
  CHECK(crossed.known > free.known - 8);
  CHECK(crossed.most_bias < 0.01);
  lens.camera.lens_radius = 0.05f;
  lens.camera.focal_distance = 2;
  CHECK(look(lens).known == 0);
  // Entirely hidden, so not visible at all.
  add_quad(behind.scene, behind.grey, {Vec3{-2, -2, 1}, {2, -2, 1}, {2, 2, 1}, {-2, 2, 1}});
  const Found none = look(behind);
  CHECK(none.known + none.unknown == 0);
  // From behind it is black.
  away.camera = look_at({0, 0, -3}, {0.2f, 0.1f, 0}, {0, 1, 0}, 40);
  const PreparedScene dark(std::move(away.scene));
  const ViewingCamera from_behind(away.camera, side, side);
  const LightOutlines outlines(dark, from_behind, window, true, 1);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      CHECK(outlines.edge_correction(x, y, {0.3f, 0.6f}, Rgb{0}).is_black());
  textured.scene.textures.emplace_back();
  textured.scene.lights[0].texture = 0;
  CHECK(look(textured).known == 0);
}

TEST_CASE("visible lamps: same mean, also in pixels with occluders, and less noise") {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.6f, 0.5f, 0.4f});
  add_box_inside(s, grey, {0, 0, 0}, {3, 3, 2.5f});
  for (int i = 0; i < 16; ++i) {
    const Vec3 p{0.5f + 0.6f * float(i % 4), 0.9f + 0.55f * float(i / 4), 2.49f};
    make_light(
        s,
        add_quad(s, grey,
                 {p, p + Vec3{0, 0.13f, 0}, p + Vec3{0.13f, 0.13f, 0}, p + Vec3{0.13f, 0, 0}}),
        Rgb{40});
  }
  for (int i = 0; i < 6; ++i) {  // wires
    const float y = 0.8f + 0.35f * float(i);
    add_quad(s, grey,
             {Vec3{0, y, 2.2f}, {3, y + 0.2f, 2.2f}, {3, y + 0.21f, 2.2f}, {0, y + 0.01f, 2.2f}});
  }
  const PreparedScene scene(std::move(s));
  const Camera camera = look_at({1.5f, 0.2f, 1}, {1.5f, 2, 2.3f}, {0, 0, 1}, 70);
  RenderOptions o;
  o.width = 40;
  o.height = 30;
  o.threads = 2;
  o.error = 0.05;
  o.indirect = Indirect::cells;
  const Ensemble ours = render_ensemble(scene, camera, o, 8);
  o.method = Method::path;
  o.indirect = Indirect::automatic;
  o.spp = 256;
  const Ensemble paths = render_ensemble(scene, camera, o, 4);
  const double spread = std::sqrt(ours.mean.variance_of_mean() + paths.mean.variance_of_mean());
  CAPTURE(ours.mean.mean());
  CAPTURE(paths.mean.mean());
  CHECK(spread < 0.004 * paths.mean.mean());  // precise enough to reveal a bias
  CHECK(std::abs(ours.mean.mean() - paths.mean.mean()) < 3.5 * spread);
  double squares = 0;
  for (const Moments& p : ours.pixels) squares += p.variance_of_mean() * 8;
  const double noise = std::sqrt(squares / double(ours.pixels.size())) / paths.mean.mean();
  MESSAGE("noise ", noise);
  CHECK(noise < 0.0075);  // .0089 without known coverage
}
