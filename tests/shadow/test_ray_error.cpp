// Compares the estimated error of direct rays with the actual one.
#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <string>

#include "clutter.h"
#include "one_source.h"

using namespace troffer;
using namespace troffer::test;

namespace test_ray_error {

namespace {

struct Errors {
  double made = 0, told = 0;  // root mean squares over scenes and seeds
};

// Measures the errors of 16 receivers on 15 cm of floor: four viewing rays of each of four pixels.
Errors errors_of(float error, const std::function<std::vector<Quad>(Random&)>& make) {
  constexpr int scenes = 4, seeds = 20, count = 16;
  Random random(3);
  double made = 0, told = 0;
  for (int s = 0; s < scenes; ++s) {
    BruteForceScene scene;
    scene.facets = make(random);
    std::vector<ShadowReceiver> receivers = receivers_on_floor(4, 0.05f);
    CertifiedOptions options;
    options.longest_list = 0;
    options.most_halvings = 0;
    options.mask_error = error;
    options.viewing_rays = 4;
    options.rays.most_direct_rays = 1024;
    double sums[4] = {}, squares[4] = {};  // per pixel
    for (uint64_t seed = 0; seed < seeds; ++seed) {
      for (uint32_t i = 0; i < count; ++i) {
        receivers[i].stream = hash_of(seed, i);
        receivers[i].pixel = hash_of(seed, 77u + i / 4);
        receivers[i].sample = i % 4;
      }
      std::vector<SourceVisibility> out(count);
      FoundFacets found;
      evaluate_alone(options, ceiling_source(), receivers, scene, found, out);
      double pixels[4] = {};
      for (size_t i = 0; i < count; ++i) {
        pixels[i / 4] += double(out[i].visible) / 4;
        told += double(out[i].variance) / (16.0 * 4 * scenes * seeds);
      }
      for (size_t p = 0; p < 4; ++p) {
        sums[p] += pixels[p];
        squares[p] += sqr(pixels[p]);
      }
    }
    for (size_t p = 0; p < 4; ++p)
      made += (squares[p] - sqr(sums[p]) / seeds) / ((seeds - 1) * 4.0 * scenes);
  }
  return {std::sqrt(made), std::sqrt(told)};
}

}  // namespace

TEST_CASE("direct rays: the estimated error is the actual error, behind random occluders") {
  for (const float error : {0.09f, 0.05f, 0.028f}) {
    const auto is_told = [&](const char* name, const auto& make) {
      const Errors e = errors_of(error, make);
      CAPTURE(std::string(name));
      CAPTURE(error);
      MESSAGE(std::string(name), " at ", error, ": made ", e.made, ", told / made ",
              e.told / e.made);
      CHECK(e.made > 0.0003);
      CHECK(e.told > (error < 0.05f ? 0.88 : 0.85) * e.made);
      CHECK(e.told < 2 * e.made);
    };
    // both kinds at once: the edge gains from smaller strata, the wires do not
    is_told("edge and thin wires", [](Random& r) {
      std::vector<Quad> out = curtain(r, 120, 0.0012f);
      out.push_back(half_plane(r));
      return out;
    });
    if (error < 0.05f) continue;
    is_told("edge", [](Random& r) { return std::vector<Quad>{half_plane(r)}; });
    is_told("edge along a side", [](Random& r) {
      const float x = 0.4f * r.next_float() - 0.2f;
      return std::vector<Quad>{parallelogram_facet({x, -3, 1}, {0, 6, 0}, {6, 0, 0})};
    });
    is_told("3 wires", [](Random& r) { return wires(r, 3, 0.05f); });
    is_told("20 wires", [](Random& r) { return wires(r, 20, 0.0075f); });
    is_told("100 parallel wires", [](Random& r) { return wires(r, 100, 0.0015f, true); });
    is_told("curtain", [](Random& r) { return curtain(r, 200, 0.015f); });
    is_told("10 leaves", [](Random& r) { return leaves(r, 10, 0.1f); });
    is_told("100 leaves", [](Random& r) { return leaves(r, 100, 0.08f); });
  }
}

}  // namespace test_ray_error
