// `--indirect auto`: paths for objects in the open, cells for rooms, and sampling of paths by
// noise.
#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "base/frame.h"
#include "base/random.h"
#include "base/warp.h"
#include "methods/path.h"
#include "methods/path_forecast.h"
#include "render/pictures.h"
#include "support/surfaceless_lights.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// Small plates in random directions, coated or of metal, under a uniform sky.
Scene heap_of_plates(uint32_t count) {
  Scene s;
  Material coated, metal;
  coated.kind = MaterialKind::coated_diffuse;
  coated.base_color.value = Rgb{0.6f, 0.4f, 0.3f};
  coated.roughness.value = 0.2f;
  metal.kind = MaterialKind::conductor;
  metal.is_reflectance = true;
  metal.base_color.value = Rgb{0.8f};
  metal.roughness.value = 0.3f;
  const std::array<uint32_t, 2> materials{add_material(s, coated), add_material(s, metal)};
  const auto number = [](uint32_t i, uint32_t k) {
    return unit_float(uint32_t(hash_of(uint64_t{i}, uint64_t{k}) >> 32));
  };
  for (uint32_t i = 0; i < count; ++i) {
    const Vec3 at = Vec3{number(i, 0), number(i, 1), number(i, 2)} - Vec3{0.5f};
    const Frame f(sphere_from_square({number(i, 3), number(i, 4)}));
    const Vec3 u = f.tangent * 0.05f, v = f.bitangent * 0.05f;
    add_quad(s, materials[i % 2], {at - u - v, at + u - v, at + u + v, at - u + v});
  }
  add_environment(s, Rgb{1});
  return s;
}

const Camera above = look_at({1.2f, -1.6f, 1}, {0, 0, 0}, {0, 0, 1}, 40);

RenderOptions small_picture() {
  RenderOptions o;
  o.indirect = Indirect::automatic;
  o.error = 0.05;
  o.width = 32;
  o.height = 24;
  o.threads = 2;
  return o;
}

// Returns the error relative to the mean. The product with two halves of a reference cancels the
// reference's noise.
double error_of(const Image& image, const std::array<Image, 2>& halves) {
  double sum = 0;
  for (size_t i = 0; i < image.pixels.size(); ++i)
    sum += double(image.pixels[i].g - halves[0].pixels[i].g) *
           double(image.pixels[i].g - halves[1].pixels[i].g);
  return std::sqrt(std::max(sum, 0.0) / double(image.pixels.size())) / mean_green(halves[0]);
}

}  // namespace

TEST_CASE("objects in the open are rendered by paths, within the asked and the estimated error") {
  const PreparedScene scene(heap_of_plates(3000));
  RenderOptions o = small_picture();
  std::array<Image, 2> halves;
  for (size_t i = 0; i < 2; ++i) {
    RenderOptions path = o;
    path.method = Method::path;
    path.spp = path.max_spp = 256;
    path.seed = 10 + i;
    halves[i] = render_now(scene, above, path).layers[0].image;
  }
  o.aovs = {Aov::error};
  for (const double asked : {0.1, 0.05}) {
    CAPTURE(asked);
    o.error = asked;
    const RenderResult r = render_now(scene, above, o);
    CHECK(r.statistics.is_by_paths);
    CHECK(r.statistics.cells.cells == 0);
    const double made = error_of(r.layers[0].image, halves);
    CHECK(made < asked);
    CHECK(made > 0.1 * asked);
    double told = 0;
    for (const Rgb& p : r.layers[1].image.pixels) told += sqr(double(p.r));
    told = std::sqrt(told / double(r.layers[1].image.pixels.size())) / mean_green(halves[0]);
    CHECK(told > 0.9 * made);
    CHECK(told < 2.2 * made);
    CHECK(std::abs(mean_green(r.layers[0].image) / mean_green(halves[0]) - 1) < 0.01);
  }
}

TEST_CASE("rendering by paths: same bytes for any number of threads and in a crop") {
  const PreparedScene scene(heap_of_plates(500));
  RenderOptions o = small_picture();
  o.aovs = {Aov::direct, Aov::indirect, Aov::error, Aov::albedo};
  o.threads = 1;
  const RenderResult whole = render_now(scene, above, o);
  REQUIRE(whole.statistics.is_by_paths);
  o.threads = 3;
  CHECK(is_identical(whole.layers, render_now(scene, above, o).layers));
  o.has_crop = true;
  o.crop = {7, 5, 25, 20};
  CHECK(pixels_off_crop(whole, render_now(scene, above, o), o.crop) == 0);
}

TEST_CASE("--indirect auto: cells if paths would cost more, or if few viewing rays are allowed") {
  Scene s;
  add_box_inside(s, add_diffuse(s, Rgb{0.7f}), {-2, -2, 0}, {2, 2, 2.5f});
  add_ceiling_light(s, 0.4f, 2.45f, Rgb{50});
  const PreparedScene room(std::move(s));
  const Camera inside = look_at({-1.5f, -1.5f, 1.4f}, {0, 0, 1}, {0, 0, 1}, 60);
  RenderOptions o = small_picture();
  o.error = 0.01;
  const RenderResult automatic = render_now(room, inside, o);
  CHECK_FALSE(automatic.statistics.is_by_paths);
  CHECK(automatic.statistics.cells.cells > 0);
  o.indirect = Indirect::cells;
  CHECK(is_identical(automatic.layers, render_now(room, inside, o).layers));

  const PreparedScene heap(heap_of_plates(500));
  o = small_picture();
  o.max_spp = 16;
  CHECK_FALSE(render_now(heap, above, o).statistics.is_by_paths);
}

TEST_CASE("--indirect auto: cells if only few paths find light") {
  Scene s;
  add_box_inside(s, add_diffuse(s, Rgb{0.6f}), {-1, -1, 0}, {1, 1, 2});
  // On the floor behind the camera.
  add_spot(s, {-0.8f, -0.8f, 1}, {0, 0, -1}, std::cos(0.02f), std::cos(0.04f), Rgb{5});
  const PreparedScene room(std::move(s));
  const Camera inside = look_at({-0.5f, -0.5f, 1.2f}, {1, 1, 1.2f}, {0, 0, 1}, 50);
  RenderOptions o = small_picture();
  o.width = 64;
  o.height = 48;
  CHECK_FALSE(render_now(room, inside, o).statistics.is_by_paths);
}

TEST_CASE("--indirect auto: cells are abandoned if they cost more than paths") {
  const PreparedScene scene(heap_of_plates(3000));
  const ViewingCamera camera(above, 160, 120);
  const PictureView view{{0, 0, 160, 120}, {0, 0, 160, 120}, [&](float x, float y) {
                           return camera.ray({x, y}, {0.5f, 0.5f});
                         }};
  Counters counters;
  RenderOptions o = small_picture();
  o.width = 160;
  o.height = 120;
  o.error = 0.01;
  // Making cells begins,
  REQUIRE(forecast_paths(paths_by_light_sampling(scene, {}), nullptr, view, 0.75 * o.error, 1 << 14,
                         o.seed, counters)
              .rays_for_cells > 0);
  // but is given up.
  CHECK(render_now(scene, above, o).statistics.is_by_paths);
}

TEST_CASE("forecast of paths: the number of rays follows from the asked error and the variance") {
  const PreparedScene scene(heap_of_plates(1000));
  const auto forecast = [&](int width, double error, int most) {
    const int height = width * 3 / 4;
    const ViewingCamera camera(above, width, height);
    const PictureView view{{0, 0, width, height}, {0, 0, width, height}, [&](float x, float y) {
                             return camera.ray({x, y}, {0.5f, 0.5f});
                           }};
    Counters counters;
    return forecast_paths(paths_by_light_sampling(scene, {}), nullptr, view, error, most, 0,
                          counters);
  };
  const PathForecast coarse = forecast(160, 0.02, 1 << 30), fine = forecast(160, 0.01, 1 << 30);
  CHECK(coarse.evenness > 0.02);  // a path's random numbers are stratified within the pixel
  CHECK(coarse.evenness < 0.35);
  CHECK(fine.evenness == doctest::Approx(coarse.evenness).epsilon(0.01));
  const double more = std::pow(4, 1 / (1 + coarse.evenness));
  CHECK(fine.viewing_rays == doctest::Approx(more * coarse.viewing_rays).epsilon(0.01));
  CHECK(fine.rays == doctest::Approx(more * coarse.rays).epsilon(0.01));
  const PathForecast large = forecast(640, 0.02, 1 << 30);
  CHECK(large.rays == doctest::Approx(16 * coarse.rays).epsilon(0.2));
  CHECK(forecast(160, 0.01, 64).viewing_rays <= 64);
}
