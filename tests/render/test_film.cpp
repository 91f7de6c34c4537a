// Sums of samples per pixel: means, errors, first hits, samples that are not finite.
#include "render/film.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "support/statistics.h"

using namespace troffer;
using troffer::test::Moments;

namespace {

RadianceBatch batch_of(const std::vector<Rgb>& direct) {
  RadianceBatch b;
  b.reset(direct.size());
  b.direct = direct;
  return b;
}

const Layer& layer_named(const std::vector<Layer>& layers, const std::string& name) {
  for (const Layer& l : layers)
    if (l.name == name) return l;
  FAIL("no layer " << name);
  return layers[0];
}

}  // namespace

TEST_CASE("the picture is the mean of its samples, the error layer their standard error") {
  Film film({3, 5, 5, 6}, {Aov::error, Aov::direct, Aov::indirect});
  RadianceBatch b = batch_of({Rgb{1}, Rgb{2}, Rgb{6}});
  b.indirect[2] = Rgb{0, 3, 0};
  for (size_t i = 0; i < 3; ++i) CHECK(film.add(4, 5, b, i, 0));
  const std::vector<Layer> layers = film.layers();
  REQUIRE(layers.size() == 4);
  CHECK(layers[0].name.empty());
  CHECK(layers[0].image.width == 2);
  CHECK(layers[0].image.height == 1);
  CHECK(layers[0].image.at(0, 0) == Rgb{0});
  CHECK(layers[0].image.at(1, 0) == Rgb{3, 4, 3});
  CHECK(layer_named(layers, "direct").image.at(1, 0) == Rgb{3});
  CHECK(layer_named(layers, "indirect").image.at(1, 0) == Rgb{0, 1, 0});
  // Luminances 1, 2, 6 + 3 × 0.7152.
  const double y[] = {1, 2, 6 + 3 * 0.7152}, m = (y[0] + y[1] + y[2]) / 3;
  double squares = 0;
  for (const double v : y) squares += (v - m) * (v - m);
  CHECK(double(layer_named(layers, "error").image.at(1, 0).r) ==
        doctest::Approx(std::sqrt(squares / 2 / 3)).epsilon(1e-5));
  CHECK(layer_named(layers, "error").channels.size() == 1);
}

TEST_CASE("equal samples have no error, however bright") {
  for (const float value : {0.1f, 3.3f, 1.2345e5f}) {
    Film film({0, 0, 1, 1}, {Aov::error});
    const RadianceBatch b = batch_of(std::vector<Rgb>(100, Rgb{value, value * 0.7f, value * 0.3f}));
    for (size_t i = 0; i < 100; ++i) film.add(0, 0, b, i, 0);
    CHECK(film.layers()[1].image.at(0, 0).r < 1e-6f * value);
  }
}

TEST_CASE("samples that are not finite count as black and are reported") {
  Film film({0, 0, 1, 1}, {Aov::error});
  const RadianceBatch b = batch_of(
      {Rgb{1}, Rgb{1, std::nanf(""), 1}, Rgb{std::numeric_limits<float>::infinity()}, Rgb{1}});
  CHECK(film.add(0, 0, b, 0, 0));
  CHECK_FALSE(film.add(0, 0, b, 1, 0));
  CHECK_FALSE(film.add(0, 0, b, 2, 0));
  CHECK(film.add(0, 0, b, 3, 0));
  const auto layers = film.layers();
  CHECK(layers[0].image.at(0, 0) == Rgb{0.5f});
  CHECK(std::isfinite(layers[1].image.at(0, 0).r));
}

TEST_CASE("first-hit layers are means over the samples that hit, normals of unit length") {
  Film film({0, 0, 1, 1}, {Aov::normal, Aov::depth, Aov::albedo, Aov::position, Aov::shadow_rays});
  RadianceBatch b = batch_of({Rgb{0}, Rgb{0}, Rgb{0}});
  b.is_hit = {1, 0, 1};
  b.normal = {{1, 0, 0}, {}, {0, 1, 0}};
  b.albedo = {Rgb{0.2f}, Rgb{0}, Rgb{0.4f}};
  b.position = {{1, 2, 3}, {}, {3, 2, 1}};
  b.shadow_rays = {6, 0, 3};
  const float depths[] = {2, 99, 4};
  for (size_t i = 0; i < 3; ++i) film.add(0, 0, b, i, depths[i]);
  const auto layers = film.layers();
  const auto pixel = [&](const char* name) { return layer_named(layers, name).image.at(0, 0); };
  CHECK(double(pixel("normal").r) == doctest::Approx(std::sqrt(0.5)));
  CHECK(double(pixel("normal").g) == doctest::Approx(std::sqrt(0.5)));
  CHECK(pixel("depth").r == 3);
  CHECK(double(pixel("albedo").g) == doctest::Approx(0.3));
  CHECK(pixel("position") == Rgb{2, 2, 2});
  CHECK(pixel("shadow_rays").r == 3);
}

namespace {

// Returns the estimated error of a pixel whose samples have an error estimate of zero by the
// method, so that only their spread counts.
double estimated_error_of(const std::vector<float>& values, bool expects_surrogates) {
  Film film({0, 0, 1, 1}, {Aov::error});
  if (expects_surrogates) film.expect_surrogates();
  RadianceBatch b;
  b.reset(values.size());
  b.enable_variance();
  b.enable_shared_error();
  b.known.assign(values.size(), {});
  for (size_t i = 0; i < values.size(); ++i) {
    b.direct[i] = Rgb{values[i]};
    film.add(0, 0, b, i, 0);
  }
  return double(film.layers()[1].image.at(0, 0).r);
}

double independent_error_of(const std::vector<float>& values) {
  Moments m;
  for (const float v : values) m.add(double(v));
  return m.standard_error();
}

TEST_CASE("the error of a picture does not depend on how bright a lamp in view is") {
  std::vector<double> luminances(100, 1), errors(100, 0.1);
  CHECK(picture_error(luminances, errors) == doctest::Approx(0.1));
  // A lamp of one pixel, which is white: four times the usual luminance of 1.
  for (const double lamp : {10.0, 1000.0, 1e6}) {
    luminances[50] = lamp;
    errors[50] = 0;
    CHECK(picture_error(luminances, errors) ==
          doctest::Approx(std::sqrt(99 * 0.01 * 100) / (99 + 4)));
    errors[50] = 0.1 * lamp;  // as if of white
    CHECK(picture_error(luminances, errors) ==
          doctest::Approx(std::sqrt((99 * 0.01 + 0.16) * 100) / (99 + 4)));
  }
  // Nothing but the lamp.
  for (size_t i = 0; i < luminances.size(); ++i)
    if (i != 50) luminances[i] = errors[i] = 0;
  CHECK(picture_error(luminances, errors) == doctest::Approx(1));
  luminances[50] = 0;
  CHECK(picture_error(luminances, errors) == 0);
}

}  // namespace

TEST_CASE("the spread of samples within pixels is reported for whole pictures") {
  // An edge: of every four samples two lie on either side.
  std::vector<float> edge, spikes;
  for (int i = 0; i < 64; ++i) {
    edge.push_back(i % 2 == 0 ? 1.0f : 2.0f);
    spikes.push_back(i % 13 == 5 ? 9.0f : 1.0f);
  }
  CHECK(estimated_error_of(edge, true) < 0.01);
  CHECK(estimated_error_of(spikes, true) ==
        doctest::Approx(independent_error_of(spikes)).epsilon(0.2));
  // With few samples the spread is reduced by the factor for edges.
  const std::vector<float> few{1, 1, 2, 2};
  for (const bool expects_surrogates : {false, true})
    CHECK(estimated_error_of(few, expects_surrogates) ==
          doctest::Approx(std::sqrt(0.5) * independent_error_of(few)).epsilon(1e-4));
}
