// Pictures and points by cells: closed forms, walls without thickness, threads and crops.
#include <doctest/doctest.h>

#include <cmath>

#include "base/random.h"
#include "render/furnace.h"
#include "render/measure.h"
#include "render/pictures.h"
#include "support/surfaceless_lights.h"

using namespace troffer;
using namespace troffer::test;

namespace test_cells {

namespace {

MeasureOptions by_cells(int spp) {
  MeasureOptions o;
  o.indirect = Indirect::cells;
  o.spp = spp;
  o.threads = 2;
  return o;
}

// Points spread evenly over the inside of a box, facing inwards.
std::vector<MeasuringPoint> points_inside(const Vec3d& a, const Vec3d& b, int along) {
  std::vector<MeasuringPoint> points;
  Random random(9);
  for (size_t axis = 0; axis < 3; ++axis)
    for (const bool is_far : {false, true})
      for (int i = 0; i < along; ++i)
        for (int j = 0; j < along; ++j) {
          MeasuringPoint& p = points.emplace_back();
          const size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
          p.position[axis] = is_far ? b[axis] : a[axis];
          p.position[u] = a[u] + (b[u] - a[u]) * (i + random.next_double()) / along;
          p.position[v] = a[v] + (b[v] - a[v]) * (j + random.next_double()) / along;
          p.normal[axis] = is_far ? -1.0f : 1.0f;
        }
  return points;
}

double mean_irradiance(const MeasureResult& r, size_t first, size_t last) {
  double sum = 0;
  for (size_t i = first; i < last; ++i) sum += double(r.values[i].irradiance.g);
  return sum / double(last - first);
}

RenderOptions picture_by_cells() {
  RenderOptions o;
  o.max_spp = 64;
  o.indirect = Indirect::cells;
  o.width = 48;
  o.height = 36;
  o.threads = 2;
  return o;
}

}  // namespace

TEST_CASE("cells: a closed cube lit by its ceiling keeps all light, for any reflectance") {
  // A share that is lost at each bounce darkens the cube by rho/(1 - rho) times as much.
  for (const float rho : {0.5f, 0.95f}) {
    Scene s;
    const auto walls = add_box_inside(s, add_diffuse(s, Rgb{rho}), {-1, -1, -1}, {1, 1, 1});
    make_light(s, walls[1], Rgb{1});
    const PreparedScene scene(std::move(s));
    const MeasureResult r =
        measure(scene, points_inside({-1, -1, -1}, {1, 1, 1}, 12), by_cells(64), {}, never_stopped);
    const double expected = pi * 4 / (24 * (1 - double(rho)));
    CAPTURE(rho);
    CHECK(mean_irradiance(r, 0, r.values.size()) == doctest::Approx(expected).epsilon(0.002));
  }
}

TEST_CASE("cells: in a furnace all pixels are equally bright within the asked error") {
  const PreparedScene scene(uneven_furnace());
  RenderOptions o = picture_by_cells();
  o.width = 32;
  o.height = 24;
  o.error = 0.01;
  const Image image = render_now(scene, furnace_camera(), o).layers[0].image;
  double squares = 0;
  int off = 0;
  for (const Rgb& p : image.pixels) {
    squares += sqr(double(p.g) / double(L0) - 1);
    off += std::abs(double(p.g) / double(L0) - 1) > 0.005 ? 1 : 0;
  }
  const auto n = double(image.pixels.size());
  CHECK(mean_green(image) == doctest::Approx(double(L0)).epsilon(0.001));
  CHECK(std::sqrt(squares / n) < 0.005);
  CAPTURE(off);
  CHECK(off < 0.2 * n);  // 21 % if errors were normal with a spread of .004
}

TEST_CASE("cells: with two rooms on one floor the dark one stays dark") {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.7f});
  add_box_inside(s, grey, {-4, -2, 0}, {4.1f, 2, 3});
  add_quad(s, grey, {Vec3{0.03f, -2, 0}, {0.03f, 2, 0}, {0.03f, 2, 3}, {0.03f, -2, 3}});
  make_light(s,
             add_quad(s, grey, {Vec3{-3, -1, 2.9f}, {-3, 1, 2.9f}, {-1, 1, 2.9f}, {-1, -1, 2.9f}}),
             Rgb{10});
  const PreparedScene scene(std::move(s));
  std::vector<MeasuringPoint> points = points_inside({-4, -2, 0}, {0.03, 2, 3}, 6);
  const size_t lit = points.size();
  for (const MeasuringPoint& p : points_inside({0.03, -2, 0}, {4.1, 2, 3}, 6)) points.push_back(p);
  const MeasureResult r = measure(scene, points, by_cells(256), {}, never_stopped);
  const double light = mean_irradiance(r, 0, lit), dark = mean_irradiance(r, lit, points.size());
  CHECK(light > 1);
  CHECK(dark <= 1e-4 * light);
}

TEST_CASE("cells: byte-identical for any number of threads, and crops are parts of the picture") {
  const PreparedScene scene(mixed_room());
  RenderOptions o = picture_by_cells();
  o.width = 32;
  o.height = 24;
  o.aovs = {Aov::direct, Aov::indirect, Aov::error};
  o.threads = 1;
  const RenderResult one = render_now(scene, mixed_room_camera(), o);
  CHECK(one.statistics.cells.cells > 100);
  CHECK(one.statistics.cells.unresolved <= 1e-5);
  CHECK(one.statistics.cells.unresolved > 0);
  CHECK(one.statistics.counters.nan_samples == 0);
  o.threads = 5;
  CHECK(is_identical(one.layers, render_now(scene, mixed_room_camera(), o).layers));
  o.threads = 2;
  o.has_crop = true;
  o.crop = {5, 3, 19, 21};
  CHECK(pixels_off_crop(one, render_now(scene, mixed_room_camera(), o), o.crop) == 0);
}

// Large enough that some pixels have no records of their own.
TEST_CASE("cells: crops of a picture with closely spaced pixels are parts of it") {
  const PreparedScene scene(mixed_room());
  RenderOptions o = picture_by_cells();
  o.width = 240;
  o.height = 180;
  o.error = 0.1;
  o.spp = 1;
  o.max_spp = 1;
  o.threads = 2;
  const RenderResult all = render_now(scene, mixed_room_camera(), o);
  o.threads = 1;
  o.has_crop = true;
  for (const auto& crop : {std::array{60, 50, 101, 91}, std::array{200, 150, 240, 180}}) {
    o.crop = crop;
    CHECK(pixels_off_crop(all, render_now(scene, mixed_room_camera(), o), o.crop) == 0);
  }
}

// A room without a light of its own behind a pane. The first room has a mirror behind the viewer.
Scene room_behind_glass() {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.6f});
  const auto walls = add_box_inside(s, grey, {-4, -2, 0}, {4, 2, 3});
  Material mirror;
  mirror.kind = MaterialKind::conductor;
  mirror.is_reflectance = true;
  mirror.base_color.value = Rgb{0.9f};
  s.meshes[walls[4]].material = add_material(s, mirror);
  Material pane;
  pane.kind = MaterialKind::dielectric;
  pane.is_thin = true;
  pane.base_color.value = Rgb{1};
  add_quad(s, add_material(s, pane), {Vec3{0, -2, 0}, {0, 2, 0}, {0, 2, 3}, {0, -2, 3}});
  // large, so that paths find it through the pane
  make_light(s, add_quad(s, grey, {Vec3{1, -2, 2.9f}, {1, 2, 2.9f}, {4, 2, 2.9f}, {4, -2, 2.9f}}),
             Rgb{10});
  return s;
}

TEST_CASE("cells: light through a pane and via a mirror arrives, within the intervals") {
  const PreparedScene scene(room_behind_glass());
  std::vector<MeasuringPoint> points;
  Random random(3);
  for (int i = 0; i < 40; ++i) {
    MeasuringPoint& p = points.emplace_back();
    p.position = {-3.9 + 3.8 * random.next_double(), -1.9 + 3.8 * random.next_double(), 0.8};
    p.normal = {random.next_float() - 0.5f, random.next_float() - 0.5f, 1};
  }
  const MeasureResult mine = measure(scene, points, by_cells(4096), {}, never_stopped);
  MeasureOptions o = by_cells(1 << 14);
  o.method = Method::path;
  o.indirect = Indirect::automatic;
  const MeasureResult paths = measure(scene, points, o, {}, never_stopped);
  double sum = 0, expected = 0, variance = 0;
  int inside = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const Measurement &a = mine.values[i], &b = paths.values[i];
    sum += a.illuminance_lx;
    expected += b.illuminance_lx;
    const double off = std::abs(a.illuminance_lx - b.illuminance_lx);
    inside += off <= 1.96 * std::hypot(a.standard_error, b.standard_error) ? 1 : 0;
    variance += sqr(b.standard_error);
  }
  CHECK(std::sqrt(variance) < 0.00125 * expected);  // precise enough to reveal a bias
  CHECK(sum == doctest::Approx(expected).epsilon(0.005));
  CHECK(inside >= 34);
}

TEST_CASE("cells: the estimated error is close to the actual error") {
  Scene s;
  add_box_inside(s, add_diffuse(s, Rgb{0.7f, 0.6f, 0.5f}), {-2, -2, 0}, {2, 2, 2.5f});
  const uint32_t dark = add_diffuse(s, Rgb{0.3f});
  s.spheres.push_back({{0.5f, 0.5f, 0.5f}, 0.5f, false, dark, no_light});
  add_ceiling_light(s, 1, 2.4f, Rgb{10});
  const PreparedScene scene(std::move(s));
  RenderOptions o = picture_by_cells();
  o.width = 24;
  o.height = 18;
  o.aovs = {Aov::indirect, Aov::error};
  RenderOptions path = o;
  path.method = Method::path;
  path.spp = 2048;
  const RenderResult mine = render_now(scene, mixed_room_camera(), o),
                     paths = render_now(scene, mixed_room_camera(), path);
  double made = 0, told = 0, noise = 0, mean = 0;
  const Image &a = mine.layers[0].image, &b = paths.layers[0].image;
  for (size_t i = 0; i < a.pixels.size(); ++i) {
    const double off = double(luminance(a.pixels[i])) - double(luminance(b.pixels[i]));
    made += off * off;
    told += double(mine.layers[2].image.pixels[i].r) * double(mine.layers[2].image.pixels[i].r);
    noise += double(paths.layers[2].image.pixels[i].r) * double(paths.layers[2].image.pixels[i].r);
    mean += double(luminance(b.pixels[i]));
  }
  const auto n = double(a.pixels.size());
  CAPTURE(std::sqrt(made / n) / (mean / n));
  CAPTURE(std::sqrt(noise / n) / (mean / n));
  CAPTURE(std::sqrt(told / n) / (mean / n));
  CHECK(std::sqrt(told) > 0.5 * std::sqrt(made));
  // Stratified rays err less than their spread shows.
  CHECK(std::sqrt(told) < 2.5 * std::sqrt(made));
}

TEST_CASE("cells: a room with mirror, glass and gloss agrees with paths") {
  const PreparedScene scene(mixed_room());
  RenderOptions o = picture_by_cells();
  o.width = 24;
  o.height = 18;
  const Ensemble mine = render_ensemble(scene, mixed_room_camera(), o, 4);
  o.method = Method::path;
  o.indirect = Indirect::automatic;
  o.spp = 256;
  const Ensemble paths = render_ensemble(scene, mixed_room_camera(), o, 4);
  CAPTURE(mine.mean.mean());
  CAPTURE(paths.mean.mean());
  CAPTURE(paths.mean.standard_error());
  CHECK(mine.mean.mean() == doctest::Approx(paths.mean.mean()).epsilon(0.005));
}

// A room whose floor has white and dark tiles of 5 cm.
Scene tiled_room() {
  Scene s;
  const auto walls = add_box_inside(s, add_diffuse(s, Rgb{0.6f}), {-1, -1, 0}, {1, 1, 2});
  Texture tiles;
  tiles.kind = TextureKind::image;
  tiles.width = tiles.height = 2;
  tiles.channels = 1;
  tiles.texels_float = {0.9f, 0.1f, 0.1f, 0.9f};
  tiles.is_srgb = tiles.is_filtered = false;
  tiles.uv_scale = {20, 20};
  s.textures.push_back(tiles);
  Mesh& floor = s.meshes[walls[0]];
  floor.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  Material m;
  m.base_color.value = Rgb{1};
  m.base_color.texture = 0;
  floor.material = add_material(s, m);
  add_ceiling_light(s, 0.8f, 1.9f, Rgb{10});
  return s;
}

TEST_CASE("cells: light on a tiled floor is smooth, and the tiles stay sharp") {
  const PreparedScene scene(tiled_room());
  const Camera camera = look_at({0, -0.9f, 1.6f}, {0, 0.3f, 0}, {0, 0, 1}, 50);
  RenderOptions o = picture_by_cells();
  o.width = 32;
  o.height = 24;
  o.aovs = {Aov::indirect, Aov::albedo};
  // Divide by the albedo that the same viewing rays have seen: few rays see few tiles.
  const auto irradiance = [&](const RenderResult& r) {
    Image image = r.layers[1].image;
    for (size_t i = 0; i < image.pixels.size(); ++i)
      image.pixels[i] = image.pixels[i] / r.layers[2].image.pixels[i].g;
    return image;
  };
  const Image mine = irradiance(render_now(scene, camera, o));
  o.method = Method::path;
  o.indirect = Indirect::automatic;
  o.spp = 2048;
  o.aovs.push_back(Aov::error);
  const RenderResult result = render_now(scene, camera, o);
  const Image paths = irradiance(result);
  double squares = 0, noise = 0;
  for (size_t i = 0; i < mine.pixels.size(); ++i) {
    const double relative =
        double(result.layers[3].image.pixels[i].g) / double(result.layers[1].image.pixels[i].g);
    noise += sqr(relative);
    squares += sqr(double(mine.pixels[i].g) / double(paths.pixels[i].g) - 1);
  }
  const auto n = double(mine.pixels.size());
  CAPTURE(std::sqrt(noise / n));
  CAPTURE(std::sqrt(squares / n));
  CHECK(mean_green(mine) == doctest::Approx(mean_green(paths)).epsilon(0.005));
  CHECK(std::sqrt(squares / n) < 0.025);  // includes the noise of paths
}

// Leaves in the open: rays of a cell hit different leaves, so cells are hardly shared.
TEST_CASE("cells: cells that few rays share send few rays") {
  Scene s;
  const uint32_t m = add_diffuse(s, Rgb{0.5f});
  Random random(11);
  for (int i = 0; i < 15'000; ++i) {
    const Vec3 c{random.next_float() * 4 - 2, random.next_float() * 4 - 2, random.next_float() * 4};
    const Vec3 u = normalize(
        Vec3{random.next_float() - 0.5f, random.next_float() - 0.5f, random.next_float() - 0.5f});
    const Vec3 v = cross(u, normalize(Vec3{0.3f, 0.5f, 0.8f}));
    constexpr float half = 0.02f;
    add_quad(s, m,
             {c - u * half - v * half, c + u * half - v * half, c + u * half + v * half,
              c - u * half + v * half});
  }
  add_environment(s, Rgb{1});
  const PreparedScene scene(std::move(s));
  RenderOptions o = picture_by_cells();
  o.width = 24;
  o.height = 18;
  o.error = 0.1;
  const RenderResult r = render_now(scene, look_at({0, -9, 2}, {0, 0, 2}, {0, 0, 1}, 35), o);
  const CellStatistics& c = r.statistics.cells;
  CAPTURE(c.cells);
  CAPTURE(c.rays);
  CHECK(c.cells > 10'000);
  CHECK(double(c.rays) < 16 * double(c.cells));  // 27 if all cells send out equally many
  o.method = Method::path;
  o.indirect = Indirect::automatic;
  o.spp = 256;
  CHECK(
      mean_green(r.layers[0].image) ==
      doctest::Approx(
          mean_green(
              render_now(scene, look_at({0, -9, 2}, {0, 0, 2}, {0, 0, 1}, 35), o).layers[0].image))
          .epsilon(0.005));
}

}  // namespace test_cells
