// Surrogate samples: the same mean, with less noise at edges.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "render/film.h"
#include "render/pictures.h"
#include "transport/allowed_error.h"
#include "transport/costs.h"

using namespace troffer;
using namespace troffer::test;

namespace {

std::vector<double> luminances_of(const Image& image) {
  std::vector<double> values;
  for (const Rgb& p : image.pixels) values.push_back(double(luminance(p)));
  return values;
}

// A room with a window that emits light, behind slats.
Scene room_behind_blinds() {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.6f, 0.5f, 0.4f}), white = add_diffuse(s, Rgb{0.8f});
  add_box_inside(s, grey, {0, 0, 0}, {3, 3, 2.5f});
  const float back = 2.99f;
  make_light(
      s,
      add_quad(s, white,
               std::array<Vec3, 4>{
                   Vec3{0.8f, back, 0.8f}, {2.2f, back, 0.8f}, {2.2f, back, 2}, {0.8f, back, 2}}),
      Rgb{10});
  for (int i = 0; i < 15; ++i) {
    const float z = 0.82f + 0.08f * float(i);
    add_quad(s, white,
             std::array<Vec3, 4>{Vec3{0.7f, 2.9f, z},
                                 {2.3f, 2.9f, z},
                                 {2.3f, 2.95f, z + 0.05f},
                                 {0.7f, 2.95f, z + 0.05f}});
  }
  return s;
}
const Camera at_window = look_at({0.5f, 0.3f, 1.5f}, {1.6f, 3, 1.3f}, {0, 0, 1}, 55);

RenderOptions small_picture() {
  RenderOptions o;
  o.indirect = Indirect::cells;
  o.width = 32;
  o.height = 24;
  o.threads = 2;
  return o;
}

// Two independent pictures of the room by path tracing. A product of differences from both does not
// contain their noise.
const std::array<Image, 2>& blinds_by_paths() {
  static const std::array<Image, 2> halves = [] {
    const PreparedScene scene(room_behind_blinds());
    std::array<Image, 2> pictures;
    for (size_t i = 0; i < 2; ++i) {
      RenderOptions o = small_picture();
      o.method = Method::path;
      o.indirect = Indirect::automatic;
      o.spp = o.max_spp = 1024;
      o.seed = 10 + i;
      pictures[i] = render_now(scene, at_window, o).layers[0].image;
    }
    return pictures;
  }();
  return halves;
}

}  // namespace

TEST_CASE(
    "surrogates: a pixel is the mean of surrogate values plus the mean difference of its samples") {
  Film film({0, 0, 2, 1}, {Aov::direct, Aov::indirect, Aov::albedo});
  film.expect_surrogates();
  RadianceBatch b;
  b.reset(2);
  b.direct = {Rgb{4}, Rgb{1}};
  b.indirect = {Rgb{1}, Rgb{2}};
  b.known = {{Rgb{3}, Rgb{0.5f}}, {Rgb{1}, Rgb{1.5f}}};
  b.is_hit = {1, 1};
  b.albedo = {Rgb{0.2f}, Rgb{0.4f}};
  for (int x = 0; x < 2; ++x)
    for (size_t i = 0; i < 2; ++i) CHECK(film.add(x, 0, b, i, 0));
  RadianceBatch surrogates;
  surrogates.reset(3);
  surrogates.known = {{Rgb{3}, Rgb{0.5f}}, {Rgb{3}, Rgb{0.5f}}, {Rgb{0}, Rgb{0.5f}}};
  surrogates.is_hit = {1, 1, 0};
  surrogates.albedo[1] = Rgb{1};
  for (size_t i = 0; i < 3; ++i) film.add_surrogate(0, 0, surrogates, i, 0);
  const std::vector<Layer> layers = film.layers();
  const double direct = (3 + 1 + 3 + 3 + 0) / 5.0 + (4 - 3 + 1 - 1) / 2.0;
  const double indirect = (0.5 + 1.5 + 3 * 0.5) / 5.0 + (1 - 0.5 + 2 - 1.5) / 2.0;
  CHECK(double(layers[1].image.at(0, 0).g) == doctest::Approx(direct));
  CHECK(double(layers[2].image.at(0, 0).g) == doctest::Approx(indirect));
  CHECK(double(layers[0].image.at(0, 0).g) == doctest::Approx(direct + indirect));
  CHECK(layers[0].image.at(1, 0) == Rgb{4});  // without surrogates: the mean of its samples
  CHECK(layers[3].image.at(0, 0) == Rgb{0.5f});
  CHECK(double(layers[3].image.at(1, 0).g) == doctest::Approx(0.3));
  const PixelEstimate e = film.estimate(0, 0);
  CHECK(e.luminance == doctest::Approx(direct + indirect));
  CHECK(e.rest == doctest::Approx(1));
  CHECK(e.error_of_rest == doctest::Approx(0.5));  // of the differences 1.5 and 0.5
  CHECK(e.standard_error == doctest::Approx(std::sqrt(0.25 + 1 * 3 / 5.0)));
}

TEST_CASE("surrogates: no pixel gets negative") {
  Film film({0, 0, 1, 1}, {});
  film.expect_surrogates();
  RadianceBatch b;
  b.reset(1);
  b.direct = {Rgb{0.2f}};
  b.known = {{Rgb{1}, Rgb{0}}};
  film.add(0, 0, b, 0, 0);
  b.known[0].direct = Rgb{0.5f};
  film.add_surrogate(0, 0, b, 0, 0);
  CHECK(film.layers()[0].image.at(0, 0) == Rgb{0.2f});
}

TEST_CASE("light outlines: a pixel that would be negative keeps the value of its rays") {
  Film film({0, 0, 2, 1}, {});
  film.expect_surrogates();
  RadianceBatch b;
  b.reset(1);
  b.known.assign(1, {});
  b.edge_correction = {Rgb{-0.5f, 0.25f, 0.25f}};
  b.direct = {Rgb{0.2f} + b.edge_correction[0]};
  b.known[0].direct = b.edge_correction[0];
  film.add(0, 0, b, 0, 0);
  CHECK(film.layers()[0].image.at(0, 0).r == doctest::Approx(0.2f));
  CHECK(film.layers()[0].image.at(0, 0).g == doctest::Approx(0.2f));
  // A pixel that stays positive keeps the correction.
  b.edge_correction = {Rgb{0.25f}};
  b.direct = {Rgb{0.2f} + b.edge_correction[0]};
  b.known[0].direct = b.edge_correction[0];
  film.add(1, 0, b, 0, 0);
  CHECK(film.layers()[0].image.at(1, 0).r == doctest::Approx(0.45f));
}

TEST_CASE("surrogates: the mean of a picture with blinds is unchanged") {
  const PreparedScene scene(room_behind_blinds());
  RenderOptions o = small_picture();
  o.spp = 4;
  o.max_spp = 16;
  const Moments refined = render_ensemble(scene, at_window, o, 5).mean;
  Moments paths;
  for (const Image& half : blinds_by_paths()) paths.add(mean_green(half));
  const double spread = std::sqrt(refined.variance_of_mean() + paths.variance_of_mean());
  CAPTURE(refined.mean());
  CAPTURE(paths.mean());
  CAPTURE(spread);
  CHECK(spread < 0.004 * paths.mean());  // precise enough to reveal a bias
  CHECK(std::abs(refined.mean() - paths.mean()) < 3.3 * spread);
}

TEST_CASE("direct light only: edges get the rays they need, and the error is estimated") {
  const PreparedScene scene(room_behind_blinds());
  RenderOptions o = small_picture();
  o.indirect = Indirect::none;
  o.max_spp = 0;
  o.spp = 4;
  constexpr int pictures = 6;
  std::vector<Image> all;
  double told = 0;
  Moments means;
  for (int i = 0; i < pictures; ++i) {
    o.seed = uint64_t(i);
    const RenderResult r = render_now(scene, at_window, o);
    CHECK(r.statistics.counters.surrogates > 0);
    CHECK(r.statistics.counters.viewing_rays > 16 * uint64_t(o.width * o.height));
    told += r.statistics.estimated_error / pictures;
    all.push_back(r.layers[0].image);
    double sum = 0;
    for (const Rgb& c : all.back().pixels) sum += double(luminance(c));
    means.add(sum / double(all.back().pixels.size()));
  }
  // Like picture_error(): limited to white, over the mean that a display shows.
  const double white = white_luminance * usual_luminance(luminances_of(all[0]));
  double squares = 0, shown = 0;
  for (size_t p = 0; p < all[0].pixels.size(); ++p) {
    Moments pixel;
    for (const Image& image : all) pixel.add(std::min(double(luminance(image.pixels[p])), white));
    squares += pixel.variance_of_mean() * pictures / double(all[0].pixels.size());
    shown += pixel.mean() / double(all[0].pixels.size());
  }
  const double made = std::sqrt(squares) / shown;
  MESSAGE("made ", made, ", told ", told);
  CHECK(made < 0.05);  // 0.5 with 16 rays at edges
  CHECK(told > 0.8 * made);
  CHECK(told < 2.5 * made);
  o.method = Method::fixed;
  o.spp = 64;
  o.shadow_rays = 16;
  const Moments fixed = render_ensemble(scene, at_window, o, 6).mean;
  const double spread = std::sqrt(means.variance_of_mean() + fixed.variance_of_mean());
  CHECK(spread < 0.01 * fixed.mean());  // precise enough to reveal a bias
  CHECK(std::abs(means.mean() - fixed.mean()) < 3.3 * spread);
}

TEST_CASE("surrogates: blinds in front of a window have less than half the error and work") {
  const PreparedScene scene(room_behind_blinds());
  RenderOptions o = small_picture();
  const auto& [first, second] = blinds_by_paths();
  const auto error = [&](const RenderResult& r) {
    double sum = 0;
    for (size_t i = 0; i < first.pixels.size(); ++i) {
      const auto off = [&](const Image& half) {
        return double(r.layers[0].image.pixels[i].g) - double(half.pixels[i].g);
      };
      sum += off(first) * off(second);
    }
    return std::sqrt(std::max(sum, 0.0) / double(first.pixels.size()));
  };
  o.seed = 1;
  o.spp = o.max_spp = 16;
  const RenderResult even = render_now(scene, at_window, o);
  CHECK(even.statistics.counters.surrogates == 0);
  o.spp = 4;
  const RenderResult refined = render_now(scene, at_window, o);
  CHECK(refined.statistics.counters.surrogates > 0);
  const auto work = [&](const RenderResult& r) {
    return cost_of(r.statistics.counters) * std::pow(error(r), 2);
  };
  CHECK(work(refined) < 0.5 * work(even));
  MESSAGE("error ", error(refined), ", by 16 rays a pixel ", error(even));
  CHECK(error(refined) < 0.5 * error(even));
  o.threads = 3;
  CHECK(is_identical(refined.layers, render_now(scene, at_window, o).layers));
  o.has_crop = true;
  o.crop = {7, 5, 25, 20};
  CHECK(pixels_off_crop(refined, render_now(scene, at_window, o), o.crop) == 0);
}

TEST_CASE("refinement: pixels behind blinds have about the asked error, for two asked errors") {
  const PreparedScene scene(room_behind_blinds());
  const std::array<Image, 2>& halves = blinds_by_paths();
  double mean = 0;
  for (const Rgb& p : halves[0].pixels) mean += double(p.g);
  mean /= double(halves[0].pixels.size());
  const auto error = [&](double asked) {
    RenderOptions o = small_picture();
    o.spp = 4;
    o.max_spp = 1024;
    o.error = asked;
    const Image image = render_now(scene, at_window, o).layers[0].image;
    double sum = 0;
    for (size_t i = 0; i < image.pixels.size(); ++i) {
      // Both limited to four times the mean.
      const auto seen = [&](const Image& of) { return std::min(double(of.pixels[i].g), 4 * mean); };
      const auto off = [&](const Image& half) { return seen(image) - seen(half); };
      sum += off(halves[0]) * off(halves[1]);
    }
    return std::sqrt(std::max(sum, 0.0) / double(image.pixels.size())) / mean;
  };
  const double coarse = error(0.05), fine = error(0.01);
  MESSAGE("of .05 ", coarse, ", of .01 ", fine);
  CHECK(coarse < 0.05);
  CHECK(fine < 0.02);
  CHECK(fine < 0.7 * coarse);
}

// The light is two thousand times as bright as the room and three pixels wide. An error of a
// thousandth of it is twice the picture's mean.
TEST_CASE("surrogates: more at the outline of very bright objects") {
  Scene s;
  add_box_inside(s, add_diffuse(s, Rgb{0.5f}), {0, 0, 0}, {3, 3, 2.5f});
  const Vec3 at{1.5f, 2.5f, 1.6f}, u{0.09f, 0, 0.03f}, v{-0.03f, 0, 0.09f};
  make_light(s,
             add_quad(s, add_diffuse(s, Rgb{0.5f}),
                      std::array<Vec3, 4>{at - u - v, at + u - v, at + u + v, at - u + v}),
             Rgb{2000});
  const PreparedScene scene(std::move(s));
  RenderOptions o = small_picture();
  o.error = 0.05;
  std::vector<Moments> pixels(size_t(o.width) * size_t(o.height));
  Moments all;
  for (int k = 0; k < 6; ++k, ++o.seed) {
    const Image picture = render_now(scene, at_window, o).layers[0].image;
    for (size_t i = 0; i < pixels.size(); ++i) {
      pixels[i].add(double(luminance(picture.pixels[i])));
      all.add(double(luminance(picture.pixels[i])));
    }
  }
  double variance = 0;
  for (const Moments& m : pixels) variance += m.variance_of_mean() * 6 / double(pixels.size());
  const double error = std::sqrt(variance) / all.mean();
  CAPTURE(all.mean());
  CAPTURE(error);
  CHECK(error < 0.02);
}
