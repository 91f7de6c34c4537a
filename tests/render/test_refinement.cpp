// Refinement keeps the mean of the picture, however small and bright the things are that rays meet.
#include <doctest/doctest.h>

#include <cmath>

#include "pictures.h"
#include "render/edge_map.h"
#include "render/refinement.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// A grey room with 100 lights under its ceiling, of the same power whatever their size.
Scene room_of_small_lights(uint32_t floor_material, float side, Scene s) {
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  const uint32_t black = add_diffuse(s, Rgb{0});
  const auto quads = add_box_inside(s, grey, {0, 0, 0}, {4, 4, 3});
  s.meshes[quads[0]].material = floor_material;
  for (int i = 0; i < 100; ++i) {
    const float x = 0.25f + 0.37f * float(i % 10), y = 0.25f + 0.37f * float(i / 10), r = side / 2;
    const std::array<Vec3, 4> corners{Vec3{x - r, y - r, 2.95f},
                                      {x - r, y + r, 2.95f},
                                      {x + r, y + r, 2.95f},
                                      {x + r, y - r, 2.95f}};
    make_light(s, add_quad(s, black, corners), Rgb{0.16f / (side * side)});
  }
  return s;
}
Scene matte_room() {
  Scene s;
  const uint32_t floor = add_diffuse(s, Rgb{0.6f});
  return room_of_small_lights(floor, 0.02f, s);
}
// The floor is a mirror that shows the lights a second time.
Scene mirror_room() {
  Scene s;
  Material mirror;
  mirror.kind = MaterialKind::conductor;
  mirror.is_reflectance = true;
  mirror.base_color.value = Rgb{0.9f};
  const uint32_t floor = add_material(s, mirror);
  return room_of_small_lights(floor, 0.06f, s);
}

// Means of whole pictures with different seeds.
Moments means_of(const PreparedScene& scene, const Camera& camera, RenderOptions o, int pictures) {
  o.seed = 1000 * uint64_t(o.spp);
  return render_ensemble(scene, camera, o, pictures).mean;
}

// Compares with direct light by path.
void check_mean(const PreparedScene& scene, const Vec3& target, float fov_deg, int pictures) {
  const Camera camera = look_at({0.3f, 0.3f, 1.6f}, target, {0, 0, 1}, fov_deg);
  RenderOptions o;
  o.method = Method::path;
  o.depth = 1;
  o.width = o.height = 48;
  o.spp = 4;
  o.max_spp = 16;
  const Moments refined = means_of(scene, camera, o, pictures);
  o.spp = o.max_spp = 128;
  const Moments right = means_of(scene, camera, o, 12);
  const double spread = std::sqrt(refined.variance_of_mean() + right.variance_of_mean());
  CAPTURE(refined.mean());
  CAPTURE(right.mean());
  CAPTURE(spread);
  CHECK(spread < 0.02 * right.mean());  // precise enough to reveal a bias
  CHECK(std::abs(refined.mean() - right.mean()) < 3.3 * spread);
}

}  // namespace

TEST_CASE("refinement keeps the mean of a picture with many small lights") {
  check_mean(PreparedScene(matte_room()), {3, 3, 2.2f}, 70, 40);
}

TEST_CASE("refinement keeps the mean where small lights are seen in a mirror") {
  check_mean(PreparedScene(mirror_room()), {3, 3, 0}, 60, 100);
}

TEST_CASE("the edge map finds borders of objects, and every pixel that a small light touches") {
  const PreparedScene scene(matte_room());
  const Camera camera = look_at({0.3f, 0.3f, 1.6f}, {3, 3, 2.2f}, {0, 0, 1}, 70);
  constexpr int side = 64;
  const ViewingCamera viewing(camera, side, side);
  const PixelRect all{0, 0, side, side};
  const EdgeMap map(scene, viewing, all, LightOutlines(scene, viewing, all, true, 1), 1);
  // Brute force: many rays in each pixel.
  size_t with_light = 0, missed = 0, marked = 0;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      bool has_light = false;
      constexpr int n = 8;
      std::vector<Ray> rays;
      for (int i = 0; i < n * n; ++i)
        rays.push_back(viewing.ray(
            {float(x) + (float(i % n) + 0.5f) / n, float(y) + (float(i / n) + 0.5f) / n},
            {0.5f, 0.5f}));
      std::vector<Hit> hits(rays.size());
      scene.tracer.closest(rays, hits);
      size_t on_light = 0;
      for (const Hit& h : hits)
        on_light += h.is_valid() && !scene.scene.meshes[h.geometry].lights.empty() ? 1 : 0;
      has_light = on_light > 0;
      with_light += has_light ? 1 : 0;
      missed += on_light > 0 && on_light < n * n && !map.has_light_edge(x, y) ? 1 : 0;
      marked += map.has_light_edge(x, y) ? 1 : 0;
    }
  CHECK(with_light > 60);
  CHECK(missed == 0);
  CHECK(marked < 2 * with_light);
  // raster_of() is the inverse of ray().
  for (const Vec2 r : {Vec2{3.25f, 7.5f}, Vec2{50, 60.75f}}) {
    const Ray ray = viewing.ray(r, {0.5f, 0.5f});
    Vec2 back;
    REQUIRE(viewing.raster_of(ray.origin + ray.direction * 3, back));
    CHECK(std::abs(back.x - r.x) < 1e-3f);
    CHECK(std::abs(back.y - r.y) < 1e-3f);
    CHECK_FALSE(viewing.raster_of(ray.origin - ray.direction, back));
  }
}

TEST_CASE(
    "the layer viewing_error is the spread of a pixel's rays, and the statistics summarize it") {
  const PreparedScene scene(matte_room());
  RenderOptions o;
  o.method = Method::certified;
  o.indirect = Indirect::none;
  o.width = o.height = 32;
  o.spp = o.max_spp = 4;
  o.aovs = {Aov::viewing_error, Aov::error};
  const Camera camera = look_at({0.3f, 0.3f, 1.6f}, {3, 3, 2.2f}, {0, 0, 1}, 70);
  const RenderResult r = render_now(scene, camera, o);
  double squares = 0, mean = 0, told = 0;
  for (size_t i = 0; i < r.layers[0].image.pixels.size(); ++i) {
    squares += double(sqr(r.layers[1].image.pixels[i].r));
    told += double(sqr(r.layers[2].image.pixels[i].r));
    mean += double(luminance(r.layers[0].image.pixels[i]));
  }
  const double n = 32 * 32;
  const ViewingErrors& e = r.statistics.viewing_errors;
  CHECK(e.relative_rms == doctest::Approx(std::sqrt(squares / n) / (mean / n)).epsilon(1e-4));
  // edges of lights, which the sampling of sources does not account for
  CHECK(squares > 100 * told);
  CHECK(e.share_above > 0.05);
  CHECK(e.share_above < 1);
}

namespace {

constexpr int middle = 6;

// Returns the number of rays for the middle pixel of a uniform panel, for an error of 2 %, after
// four samples with these values. tells: by the method's estimate, none of the variance is
// independent of the position.
template <class Value>
int wanted_amid(const Value& value, bool tells = false) {
  constexpr int side = 2 * middle + 1;
  Scene s;
  add_quad(s, add_diffuse(s, Rgb{0.5f}), {Vec3{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}});
  make_light(s, 0, Rgb{1});
  const PreparedScene scene(std::move(s));
  const Camera camera = look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 40);
  const PixelRect window{0, 0, side, side};
  const ViewingCamera viewing(camera, side, side);
  const EdgeMap edges(scene, viewing, window, LightOutlines(scene, viewing, window, true, 1), 1);
  Film film(window, {});
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      for (int k = 0; k < 4; ++k) {
        RadianceBatch batch;
        batch.reset(1);
        if (tells) {
          batch.enable_variance();
          batch.luminance_with_error.assign(1, 0);
        }
        batch.direct[0] = Rgb{float(value(x, y, k))};
        film.add(x, y, batch, 0, 3);
      }
  const PixelRecords records(window);
  RefinementOptions options;
  options.error = 0.02f;
  options.is_everywhere = true;
  const PixelLooks looks(film, false, window, middle, middle + 1);
  return samples_wanted({looks, records, edges, 1}, middle, middle, false, 4, 1024, options);
}

}  // namespace

// In clutter, a few rays that all see the same do not prove that nothing else is there.
TEST_CASE("a pixel with similar neighbours gets more rays amid clutter, and none beside a line") {
  const auto wanted = [&](const auto& varies) {
    return wanted_amid([&](int x, int y, int k) { return k == 0 && varies(x, y) ? 0.2 : 1.0; });
  };
  const auto is_far = [](int x, int y) {
    return std::max(std::abs(x - middle), std::abs(y - middle)) > 1;
  };
  CHECK(wanted([](int, int) { return false; }) == 4);
  CHECK(wanted([](int x, int) { return x == middle + 2; }) == 4);
  // Others around get 400, the number for a share of a quarter.
  const int amid = wanted(is_far);
  CHECK(amid > 16);
  CHECK(amid < 200);
  CHECK(wanted([](int x, int) { return x == middle + 1; }) > 200);
}

TEST_CASE("a gradient needs no more rays, an edge fewer than random noise") {
  // Samples in the quarters of a pixel; 40 % from one pixel to the next.
  const auto slope = [](int x, int, int k) {
    return 1 + 0.4 * (x - middle) + (k % 2 == 0 ? -0.1 : 0.1);
  };
  const auto uneven = [](int, int, int k) { return k % 2 == 0 ? 0.9 : 1.1; };
  CHECK(wanted_amid(slope) == 4);
  CHECK(wanted_amid(slope, true) == 4);
  // (.0133 / .0004) to the power of 2/3 with stratified samples.
  CHECK(wanted_amid(uneven) == 34);
  CHECK(wanted_amid(uneven, true) == 11);
}
