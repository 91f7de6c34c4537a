// Indirect light meets the asked error where neighbours share it, and where it comes from few
// cells.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "render/pictures.h"
#include "support/light_scenes.h"
#include "support/surfaceless_lights.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// A patch of light on the floor, two or three cells wide, illuminates everything else.
Scene room_with_patch() {
  Scene s;
  add_box_inside(s, add_diffuse(s, Rgb{0.7f, 0.6f, 0.5f}), {-2, -2, 0}, {2, 2, 2.5f});
  add_spot(s, {1, 0.5f, 2.4f}, {0, 0, -1}, 0.997f, 0.9968f, Rgb{100});
  return s;
}

RenderOptions picture(double error, uint64_t seed) {
  RenderOptions o;
  o.width = 64;
  o.height = 48;
  o.threads = 2;
  o.error = error;
  o.seed = seed;
  o.aovs = {Aov::indirect};
  return o;
}

// Returns the means of 8 × 8 pixels.
std::vector<double> blocks(const Image& image) {
  std::vector<double> means;
  for (int y = 0; y < image.height; y += 8)
    for (int x = 0; x < image.width; x += 8) {
      double& sum = means.emplace_back();
      for (int j = y; j < y + 8; ++j)
        for (int i = x; i < x + 8; ++i)
          sum += double(luminance(image.pixels[size_t(j * image.width + i)])) / 64;
    }
  return means;
}

}  // namespace

TEST_CASE("reflected light has no blotches and the same mean for every seed") {
  const PreparedScene scene(room_with_patch());
  std::vector<std::vector<double>> pictures;
  for (uint64_t seed = 1; seed <= 8; ++seed)
    pictures.push_back(
        blocks(render_now(scene, mixed_room_camera(), picture(0.05, seed)).layers[1].image));
  const size_t n = pictures[0].size();
  std::vector<double> mean(n), sums(pictures.size());
  double all = 0;
  for (size_t p = 0; p < pictures.size(); ++p)
    for (size_t b = 0; b < n; ++b) {
      mean[b] += pictures[p][b] / double(pictures.size());
      sums[p] += pictures[p][b] / double(n);
      all += pictures[p][b] / double(n * pictures.size());
    }
  double stains = 0, shift = 0;
  for (size_t p = 0; p < pictures.size(); ++p) {
    shift += sqr(sums[p] / all - 1) / double(pictures.size() - 1);
    // each relative to its own mean
    for (size_t b = 0; b < n; ++b)
      stains += sqr((pictures[p][b] / sums[p] - mean[b] / all) * all) /
                (sqr(all) * double(n * (pictures.size() - 1)));
  }
  CAPTURE(std::sqrt(stains));
  CAPTURE(std::sqrt(shift));
  // .05 and .05 with 24 seeds
  CHECK(std::sqrt(stains) < 0.056);
  CHECK(std::sqrt(shift) < 0.06);
}
