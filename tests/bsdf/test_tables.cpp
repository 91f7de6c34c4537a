// Tables of scenes with many materials: each material scatters as if it were alone in the scene.
#include "bsdf/tables.h"

#include <doctest/doctest.h>

#include <functional>

#include "bsdf/index_classes.h"
#include "bsdf/samples.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// Returns the largest difference of energy between materials among the others and alone.
double worst_difference(const std::vector<Material>& materials, const std::vector<size_t>& tested) {
  const Specimens all(materials);
  double worst = 0;
  for (const size_t i : tested) {
    const Specimens alone(std::vector<Material>{materials[i]});
    for (const bool is_front : {true, false})
      for (const float c : {0.1f, 0.4f, 1.0f}) {
        const Vec3 w = direction(c);
        const double among = scattered(all.at(i, is_front), w, 1u << 11).total();
        worst = std::max(worst,
                         std::abs(among - scattered(alone.at(0, is_front), w, 1u << 11).total()));
      }
  }
  return worst;
}

}  // namespace

// The first 40 materials lie close together, and the last is far from them.
TEST_CASE("beyond the number of tables, an odd index of refraction keeps a table of its own") {
  const auto worst = [](const std::function<Material(float)>& make) {
    std::vector<Material> materials;
    for (int i = 0; i < 40; ++i) materials.push_back(make(1.3f + 0.002f * float(i)));
    materials.push_back(make(2.4f));
    return worst_difference(materials, {0, 17, 40});
  };
  // The step of 0.002 between indices changes energy by less than 0.002.
  CHECK(worst([](float ior) { return coated(0.4f, Rgb{0.8f}, ior); }) < 0.003);
  CHECK(worst([](float ior) { return glass(0.4f, ior); }) < 0.003);
  CHECK(worst([](float ior) { return clear_coated(gltf(0.4f, 1), 0.3f, 1, ior); }) < 0.003);
  CHECK(worst([](float ior) { return clear_coated(copper(0.3f), 0.3f, 1, ior); }) < 0.003);
}

TEST_CASE("the 41st pair of widths still returns the light lost between microfacets") {
  std::vector<Material> brushed_metals, coated_metals;
  for (int i = 0; i <= 40; ++i) {
    const float alpha = 0.2f + 0.02f * float(i);
    brushed_metals.push_back(brushed(mirror_metal(alpha), 0.5f));
    coated_metals.push_back(clear_coated(mirror_metal(alpha), 0.1f));
  }
  CHECK(worst_difference(brushed_metals, {0, 40}) == 0);
  CHECK(worst_difference(coated_metals, {0, 40}) < 1e-6);
  // White metal reflects everything.
  const Specimens s(brushed_metals);
  CHECK(scattered(s.at(40), direction(0.5f)).total() == doctest::Approx(1).epsilon(0.01));
}

TEST_CASE("classes of indices are few, small and on one side of 1") {
  IndexClasses classes;
  std::vector<float> indices;
  for (int i = 0; i < 1000; ++i) indices.push_back(0.7f + 0.002f * float(i % 500));
  indices.push_back(80);
  for (const float x : indices) classes.add(x);
  classes.divide(32);
  CHECK(classes.size() <= 32);
  for (const float x : indices) {
    const float r = classes.representative(size_t(classes.of(x)));
    CAPTURE(x);
    CAPTURE(r);
    CHECK((r < 1) == (x < 1));
    // 30 classes share the range of 0.7 to 1.7: half of ln(1.7 / 0.7) / 30 is 1.5 %.
    CHECK(std::abs(std::log(r / x)) < 0.017f);
  }
  // Each index has a table of its own.
  IndexClasses few;
  for (const float x : {1.5f, 1.33f, 1.5f, 2.4f}) few.add(x);
  few.divide(32);
  CHECK(few.size() == 3);
  for (const float x : {1.5f, 1.33f, 2.4f}) CHECK(few.representative(size_t(few.of(x))) == x);
}
