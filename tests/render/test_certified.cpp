// Whole pictures by certified visibility: threads, reference pictures, indirect light.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>

#include "image/read_image.h"
#include "import/import.h"
#include "render/measure.h"
#include "render/pictures.h"

using namespace troffer;
using namespace troffer::test;

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

}  // namespace

TEST_CASE("certified: byte-identical for any number of threads") {
  Scene s = mixed_room();
  // Where rays decide, what one cluster found helps the next.
  for (int i = 0; i < 40; ++i)
    s.disks.push_back({{-1.5f + 0.3f * float(i % 8), -1.2f + 0.4f * float(i / 8), 1.6f},
                       {0, 0, 1},
                       0.1f,
                       0,
                       no_emitter});
  const PreparedScene scene(std::move(s));
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
    for (const int threads : {2, 3, 5}) {
      o.threads = threads;
      const RenderResult other = render_now(scene, mixed_room_camera(), o);
      CAPTURE(threads);
      CHECK(is_identical(one.layers, other.layers));
      CHECK(other.statistics.counters.lit_certified == c.lit_certified);
      CHECK(other.statistics.counters.shadow_rays == c.shadow_rays);
    }
  }
}

TEST_CASE("certified --indirect none: the direct light of fixed; every pixel") {
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
  // The expectation is noisy itself, hence the tolerance.
  const size_t off = pixels_off(
      mine, [&](size_t i) { return double(fixed.pixels[i].g); }, 0.03);
  CHECK(off == 0);
  CHECK(mine.mean.mean() == doctest::Approx(mean_green(fixed)).epsilon(0.005));
}

TEST_CASE("certified: with indirect light, the mean of path's picture") {
  const PreparedScene scene(mixed_room());
  RenderOptions o = certified_options();
  o.kj92.radiosity.unshot_fraction = 0.01f;
  o.kj92.radiosity.meshing.element_size = 0.2f;
  o.spp = 16;
  const double mine = mean(render_now(scene, mixed_room_camera(), o).layers[0].image);
  o.method = Method::path;
  o.spp = 256;
  CHECK(mine == doctest::Approx(mean(render_now(scene, mixed_room_camera(), o).layers[0].image))
                    .epsilon(0.03));
}

TEST_CASE("certified: refinement goes to edges, and gains by it") {
  const std::string root(TROFFER_SOURCE_DIR);
  const PreparedScene scene(import_scene(root + "/scenes/kj92room/kj92room_direct.pbrt"));
  RenderOptions o;
  o.method = Method::certified;
  o.indirect = Indirect::none;
  o.width = o.height = 96;
  o.threads = 2;
  o.spp = 256;
  const Image converged = render_now(scene, scene.scene.cameras.at(0), o).layers[0].image;
  const auto error = [&](const RenderResult& r) {
    double sum = 0;
    for (size_t i = 0; i < converged.pixels.size(); ++i)
      sum += std::pow(double(r.layers[0].image.pixels[i].g) - double(converged.pixels[i].g), 2);
    return std::sqrt(sum / double(converged.pixels.size()));
  };
  o.seed = 1;
  o.spp = 4;
  o.max_spp = 16;
  const RenderResult refined = render_now(scene, scene.scene.cameras.at(0), o);
  o.threads = 3;
  CHECK(is_identical(refined.layers, render_now(scene, scene.scene.cameras.at(0), o).layers));
  o.max_spp = 0;
  o.spp = 8;
  const RenderResult even = render_now(scene, scene.scene.cameras.at(0), o);
  MESSAGE("rays ", refined.statistics.counters.viewing_rays, " of ",
          even.statistics.counters.viewing_rays, ", error ", error(refined), " of ", error(even));
  CHECK(refined.statistics.counters.viewing_rays < even.statistics.counters.viewing_rays);
  CHECK(error(refined) < error(even));
}

TEST_CASE("certified: kj92room as its reference shows it") {
  const std::string root(TROFFER_SOURCE_DIR);
  const std::string reference = root + "/../shared/scenes/references/kj92room_direct.exr";
  if (!std::filesystem::exists(reference)) {
    MESSAGE("skipped: no ", reference);
    return;
  }
  const Image expected = read_image(reference);
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
  CHECK(relative_rmse < 0.02);  // mostly the edges of objects, at 4 viewing rays per pixel
  CHECK(result.statistics.counters.shadow_rays == 0);
}

TEST_CASE("certified: measures what path measures") {
  const PreparedScene scene(mixed_room());
  MeasureOptions o;
  o.method = Method::certified;
  o.kj92.radiosity.meshing.element_size = 0.2f;
  o.kj92.radiosity.unshot_fraction = 0.01f;
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
