// Whole pictures by certified visibility: threads, reference pictures, indirect light.
#include <doctest/doctest.h>

#include <cmath>

#include "image/read_image.h"
#include "import/import.h"
#include "render/measure.h"
#include "render/pictures.h"

using namespace troffer;
using namespace troffer::test;

namespace test_certified {

namespace {

RenderOptions certified_options() {
  RenderOptions o;
  o.method = Method::certified;
  o.kj92.radiosity.meshing.element_size = 0.4f;
  o.kj92.radiosity.meshing.patch_size = 1.2f;
  o.kj92.radiosity.unshot_fraction = 0.05f;
  o.width = 48;
  o.height = 36;
  o.threads = 2;
  return o;
}

// Rays decide much of the visibility here, and occluders found by one cluster serve the next.
Scene room_with_leaves() {
  Scene s = mixed_room();
  for (int i = 0; i < 40; ++i) {
    const float x = -1.6f + 0.3f * float(i % 8), y = -1.3f + 0.4f * float(i / 8), size = 0.2f;
    add_leaf(
        s,
        {Vec3{x, y, 1.6f}, {x + size, y, 1.6f}, {x + size, y + size, 1.6f}, {x, y + size, 1.6f}});
  }
  return s;
}

}  // namespace

TEST_CASE("certified: a crop holds the same pixels as the whole picture") {
  const PreparedScene scene(room_with_leaves());
  RenderOptions o = certified_options();
  o.indirect = Indirect::none;
  o.aovs = {Aov::direct, Aov::shadow_rays, Aov::error};
  for (const int max_spp : {0, 4}) {  // refined or not
    o.max_spp = max_spp;
    o.has_crop = false;
    const RenderResult whole = render_now(scene, mixed_room_camera(), o);
    CHECK(whole.statistics.counters.shadow_rays > 0);
    o.has_crop = true;
    for (const auto& crop : {std::array<int, 4>{5, 3, 29, 31}, {0, 0, 1, 1}, {47, 35, 48, 36}}) {
      o.crop = crop;
      const RenderResult part = render_now(scene, mixed_room_camera(), o);
      CHECK(part.statistics.width == crop[2] - crop[0]);
      CHECK(pixels_off_crop(whole, part, crop) == 0);
    }
  }
}

TEST_CASE("certified: byte-identical for any number of threads") {
  const PreparedScene scene(room_with_leaves());
  for (const Indirect indirect : {Indirect::automatic, Indirect::none}) {
    RenderOptions o = certified_options();
    o.indirect = indirect;
    o.aovs = {Aov::direct, Aov::indirect, Aov::shadow_rays, Aov::sources, Aov::error};
    o.threads = 1;
    const RenderResult one = render_now(scene, mixed_room_camera(), o);
    CHECK(one.is_complete);
    CHECK(is_finite(one.layers[0].image));
    const Counters& c = one.statistics.counters;
    CHECK(c.lit_certified > 0);
    CHECK(c.mixed > 0);
    CHECK(c.shadow_rays > 0);
    CHECK(c.nan_samples == 0);
    o.threads = 5;
    const RenderResult other = render_now(scene, mixed_room_camera(), o);
    CHECK(is_identical(one.layers, other.layers));
    CHECK(other.statistics.counters.lit_certified == c.lit_certified);
    CHECK(other.statistics.counters.shadow_rays == c.shadow_rays);
  }
}

TEST_CASE("certified --indirect none: every pixel agrees with the direct light of fixed") {
  const PreparedScene scene(mixed_room());
  RenderOptions o = certified_options();
  o.indirect = Indirect::none;
  o.width = 16;
  o.height = 12;
  constexpr int sets = 16;
  const Ensemble mine = render_ensemble(scene, mixed_room_camera(), o, sets);
  o.method = Method::fixed;
  o.spp = 1024;
  o.shadow_rays = 4;
  o.seed = 1000;
  const Image fixed = render_now(scene, mixed_room_camera(), o).layers[0].image;
  // The expectation has noise, hence the tolerance.
  const size_t off = pixels_off(
      mine, [&](size_t i) { return double(fixed.pixels[i].g); }, 0.03);
  CHECK(off == 0);
  CHECK(mine.mean.mean() == doctest::Approx(mean_green(fixed)).epsilon(0.005));
}

TEST_CASE("certified: with indirect light, the mean agrees with path") {
  const PreparedScene scene(mixed_room());
  RenderOptions o = certified_options();
  o.kj92.radiosity.unshot_fraction = 0.02f;
  o.kj92.radiosity.meshing.element_size = 0.3f;
  o.spp = 16;
  const double mine = mean(render_now(scene, mixed_room_camera(), o).layers[0].image);
  o.method = Method::path;
  o.spp = 256;
  CHECK(mine == doctest::Approx(mean(render_now(scene, mixed_room_camera(), o).layers[0].image))
                    .epsilon(0.03));
}

TEST_CASE("certified: refinement adds rays at edges and reduces the error") {
  const std::string root(TROFFER_SOURCE_DIR);
  const PreparedScene scene(import_scene(root + "/scenes/kj92room/kj92room_direct.pbrt"));
  RenderOptions o;
  o.method = Method::certified;
  o.indirect = Indirect::none;
  o.width = o.height = 96;
  o.threads = 2;
  o.spp = o.max_spp = 128;
  const Image converged = render_now(scene, scene.scene.cameras.at(0), o).layers[0].image;
  const auto error = [&](const RenderResult& r) {
    double sum = 0;
    for (size_t i = 0; i < converged.pixels.size(); ++i)
      sum += std::pow(double(r.layers[0].image.pixels[i].g) - double(converged.pixels[i].g), 2);
    return std::sqrt(sum / double(converged.pixels.size()));
  };
  o.seed = 1;
  o.spp = 4;
  o.max_spp = 0;
  CHECK(most_viewing_rays(o).in_pixel == 1024);
  CHECK(most_viewing_rays(o).in_mean == 512);
  o.indirect = Indirect::automatic;
  CHECK(most_viewing_rays(o).in_pixel == 2048);
  CHECK(most_viewing_rays(o).in_mean == 1024);
  o.indirect = Indirect::none;
  const RenderResult refined = render_now(scene, scene.scene.cameras.at(0), o);
  o.threads = 3;
  CHECK(is_identical(refined.layers, render_now(scene, scene.scene.cameras.at(0), o).layers));
  o.spp = o.max_spp = 32;
  const RenderResult even = render_now(scene, scene.scene.cameras.at(0), o);
  MESSAGE("rays ", refined.statistics.counters.viewing_rays, " of ",
          even.statistics.counters.viewing_rays, ", error ", error(refined), " of ", error(even));
  CHECK(refined.statistics.counters.viewing_rays < even.statistics.counters.viewing_rays);
  CHECK(error(refined) < error(even));
}

TEST_CASE("certified: kj92room agrees with its reference") {
  const std::string root(TROFFER_SOURCE_DIR);
  const Image expected = read_image(root + "/scenes/references/kj92room_direct.exr");
  const PreparedScene scene(import_scene(root + "/scenes/kj92room/kj92room_direct.pbrt"));
  RenderOptions o;
  o.method = Method::certified;
  o.indirect = Indirect::none;
  o.width = expected.width;
  o.height = expected.height;
  o.threads = 2;
  const RenderResult result = render_now(scene, scene.scene.cameras.at(0), o);
  const Image& image = result.layers[0].image;
  double sum = 0;
  for (size_t i = 0; i < image.pixels.size(); ++i)
    for (size_t c = 0; c < 3; ++c)
      sum += std::pow(double(image.pixels[i][c]) - double(expected.pixels[i][c]), 2);
  const double relative_rmse = std::sqrt(sum / double(3 * image.pixels.size())) / mean(expected);
  MESSAGE("relative RMSE ", relative_rmse);
  CHECK(mean(image) == doctest::Approx(mean(expected)).epsilon(1e-3));
  CHECK(relative_rmse < 0.01);  // mostly noise of the reference and edges of objects
  // Nearly everything is certified or masked, for further rays as well.
  const Counters& counters = result.statistics.counters;
  CHECK(counters.shadow_rays < counters.viewing_rays);  // at edges, where samples cost less
  o.max_spp = o.spp;
  CHECK(render_now(scene, scene.scene.cameras.at(0), o).statistics.counters.shadow_rays == 0);
}

TEST_CASE("certified: measured values agree with path") {
  const PreparedScene scene(mixed_room());
  MeasureOptions o;
  o.method = Method::certified;
  o.kj92.radiosity.meshing.element_size = 0.3f;
  o.kj92.radiosity.unshot_fraction = 0.02f;
  o.threads = 2;
  const std::vector<MeasuringPoint> points{{{0, 0, 0.5f}, {0, 0, 1}}, {{-1.5f, -1, 1}, {1, 0, 0}}};
  for (const Indirect indirect : {Indirect::none, Indirect::automatic}) {
    o.indirect = indirect;
    o.method = Method::certified;
    o.spp = 512;
    const MeasureResult mine = measure(scene, points, o, {}, never_stopped);
    CHECK(mine.is_complete);
    o.method = Method::path;
    o.spp = 1 << 14;
    const MeasureResult path = measure(scene, points, o, {}, never_stopped);
    const bool is_direct = indirect == Indirect::none;
    for (size_t i = 0; i < points.size(); ++i) {
      CAPTURE(i);
      CAPTURE(is_direct);
      CHECK(mine.values[i].illuminance_lx ==
            doctest::Approx(path.values[i].illuminance_lx).epsilon(is_direct ? 0.01 : 0.05));
    }
  }
}

TEST_CASE("certified: direct light on desk and floor agrees with path, with a smaller error") {
  const std::string root(TROFFER_SOURCE_DIR);
  const PreparedScene scene(import_scene(root + "/scenes/kj92room/kj92room_direct.pbrt"));
  std::vector<MeasuringPoint> points;
  for (int i = 0; i < 60; ++i)
    points.push_back({{0.2f + 0.06f * float(i), 3.7f - 0.055f * float(i % 20), 0}, {0, 0, 1}});
  MeasureOptions o;
  CHECK(o.method == Method::certified);
  o.indirect = Indirect::none;
  o.threads = 2;
  o.spp = 256;
  const MeasureResult mine = measure(scene, points, o, {}, never_stopped);
  o.method = Method::path;
  o.spp = 1 << 15;
  const MeasureResult path = measure(scene, points, o, {}, never_stopped);
  size_t far = 0, penumbra = 0;
  double squares = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const Measurement &a = mine.values[i], &b = path.values[i];
    if (a.standard_error > 0) ++penumbra;
    CHECK(a.standard_error <= 2e-3 * a.illuminance_lx + 1e-6);
    // Single precision of exact terms, and 1e-5 for the bias of ratio estimators.
    const double s =
        std::hypot(a.standard_error, b.standard_error) + 1e-5 * b.illuminance_lx + 1e-9;
    const double z = (a.illuminance_lx - b.illuminance_lx) / s;
    squares += z * z / double(points.size());
    far += std::abs(z) > 2 ? 1 : 0;
  }
  MESSAGE(penumbra, " points in penumbra; mean square z ", squares);
  CHECK(penumbra > 10);
  CHECK(far <= 9);
  CHECK(squares < 2);
}

TEST_CASE("certified: the standard error of measured values equals their spread over seeds") {
  const PreparedScene scene(mixed_room());
  MeasureOptions o;
  o.method = Method::certified;
  o.kj92.radiosity.meshing.element_size = 0.4f;
  o.kj92.radiosity.meshing.patch_size = 1.2f;
  o.kj92.radiosity.unshot_fraction = 0.05f;
  o.threads = 2;
  o.spp = 128;
  const auto preparation =
      prepare(scene, o.method, o.kj92, o.indirect, std::nullopt, 2, {}, never_stopped);
  o.preparation = preparation.get();
  const std::vector<MeasuringPoint> points{
      {{0, 0, 0.5f}, {0, 0, 1}}, {{-1.5f, -1, 1}, {1, 0, 0}}, {{1, 1, 0.1f}, {0, 0, 1}}};
  constexpr int seeds = 32;
  std::vector<Moments> values(points.size());
  std::vector<double> claimed(points.size(), 0);
  for (int seed = 0; seed < seeds; ++seed) {
    o.seed = uint64_t(seed);
    const MeasureResult r = measure(scene, points, o, {}, never_stopped);
    for (size_t i = 0; i < points.size(); ++i) {
      values[i].add(r.values[i].illuminance_lx);
      claimed[i] += std::pow(r.values[i].standard_error, 2) / seeds;
    }
  }
  for (size_t i = 0; i < points.size(); ++i) {
    CAPTURE(i);
    // The spread of 32 values has an error of about 13 %.
    CHECK(claimed[i] / (values[i].variance_of_mean() * seeds) ==
          doctest::Approx(1.08).epsilon(0.6));
  }
}

TEST_CASE("certified: the estimated error is between the actual error and twice that") {
  const std::string root(TROFFER_SOURCE_DIR);
  for (const char* name :
       {"/scenes/kj92room/kj92room_direct.pbrt", "/scenes/modern-hall/modern-hall-diffuse.pbrt"}) {
    const PreparedScene scene(import_scene(root + name));
    RenderOptions o;
    o.method = Method::certified;
    o.indirect = Indirect::none;
    o.width = 96;
    o.height = 72;
    o.threads = 2;
    o.spp = o.max_spp = 4;
    o.aovs = {Aov::error};
    // The same viewing rays, with sources sampled far better by other random numbers.
    o.error = 0.001;
    const Image better = render_now(scene, scene.scene.cameras.at(0), o).layers[0].image;
    for (const double error : {0.05, 0.01}) {
      o.error = error;
      const RenderResult told = render_now(scene, scene.scene.cameras.at(0), o);
      double made2 = 0, told2 = 0;
      for (size_t i = 0; i < better.pixels.size(); ++i) {
        const Rgb difference = told.layers[0].image.pixels[i] - better.pixels[i];
        made2 += sqr(double(luminance(difference)));
        told2 += sqr(double(told.layers[1].image.pixels[i].r));
      }
      CAPTURE(name);
      CAPTURE(error);
      MESSAGE(name, " at ", error, ": told / made ", std::sqrt(told2 / made2));
      CHECK(told2 > made2);
      CHECK(told2 < 2.0 * 2.0 * made2);
    }
  }
}

}  // namespace test_certified
