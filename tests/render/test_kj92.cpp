// Whole pictures by the kj92 method: threads, refinement, stops, degenerate scenes.
#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <thread>

#include "import/import.h"
#include "render/measure.h"
#include "render/pictures.h"
#include "render/preparation.h"
#include "support/stopwatch.h"

using namespace troffer;
using namespace troffer::test;

namespace {

RenderOptions coarse() {
  RenderOptions o;
  o.method = Method::kj92;
  o.kj92.radiosity.meshing.element_size = 0.4f;
  o.kj92.radiosity.meshing.patch_size = 1.2f;
  o.kj92.radiosity.unshot_fraction = 0.05f;
  o.width = 48;
  o.height = 36;
  o.threads = 2;
  return o;
}

// A lit room with a table, and a lamp that shines upwards.
Scene room_with_table() {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.6f, 0.5f, 0.4f});
  add_box_inside(s, grey, {-2, -2, 0}, {2, 2, 2.5f});
  add_quad(
      s, grey,
      {Vec3{-0.6f, -0.2f, 0.8f}, {0.7f, -0.2f, 0.8f}, {0.7f, 0.8f, 0.8f}, {-0.6f, 0.8f, 0.8f}});
  add_ceiling_light(s, 0.8f, 2.4f, Rgb{9, 8, 7});
  return s;
}
Camera table_camera() {
  return look_at({-1.4f, -1.8f, 1.5f}, {0.3f, 0.6f, 0.4f}, {0, 0, 1}, 60);
}

double rmse(const Image& a, const Image& b) {
  double sum = 0;
  for (size_t i = 0; i < a.pixels.size(); ++i)
    sum += std::pow(double(a.pixels[i].g) - double(b.pixels[i].g), 2);
  return std::sqrt(sum / double(a.pixels.size()));
}

}  // namespace

TEST_CASE("kj92: byte-identical for any number of threads, with and without coherence") {
  const PreparedScene scene(mixed_room());
  const auto preparation = prepare(scene, Method::kj92, coarse().kj92, Indirect::automatic,
                                   std::nullopt, 2, {}, never_stopped);
  for (const bool has_coherence : {true, false})
    for (const int max_spp : {0, 16}) {
      RenderOptions o = coarse();
      // Prepared in advance once, otherwise by render() with as many threads.
      if (has_coherence || max_spp > 0) o.preparation = preparation.get();
      o.kj92.sampling.has_coherence = has_coherence;
      o.max_spp = max_spp;
      o.spp = 4;
      o.aovs = {Aov::direct,  Aov::indirect, Aov::shadow_rays,
                Aov::sources, Aov::error,    Aov::normal};
      o.threads = 1;
      const RenderResult one = render_now(scene, mixed_room_camera(), o);
      CHECK(one.is_complete);
      CHECK(is_finite(one.layers[0].image));
      for (const int threads : {has_coherence ? 2 : 3, 5}) {
        o.threads = threads;
        const RenderResult other = render_now(scene, mixed_room_camera(), o);
        CAPTURE(threads);
        CHECK(is_identical(one.layers, other.layers));
        CHECK(one.statistics.counters.shadow_rays == other.statistics.counters.shadow_rays);
      }
    }
}

TEST_CASE("kj92: identical with hundreds of sources, more than a thread stores patterns for") {
  Scene s = room_with_table();
  const uint32_t black = add_diffuse(s, Rgb{0});
  for (int i = 0; i < 150; ++i) {
    const float x = -1.5f + 0.2f * float(i % 15), y = -1.5f + 0.3f * float(i / 15);
    make_light(s,
               add_quad(s, black,
                        {Vec3{x, y, 2.3f},
                         {x, y + 0.05f, 2.3f},
                         {x + 0.05f, y + 0.05f, 2.3f},
                         {x + 0.05f, y, 2.3f}}),
               Rgb{float(1 + i % 7) * 3});
  }
  const PreparedScene scene(std::move(s));
  RenderOptions o = coarse();
  o.spp = 1;
  o.kj92.selection.is_enabled = false;  // all sources everywhere
  const Kj92Settings settings = o.kj92;
  const auto preparation = prepare(scene, Method::kj92, settings, Indirect::automatic, std::nullopt,
                                   2, {}, never_stopped);
  o.preparation = preparation.get();
  o.threads = 1;
  const RenderResult one = render_now(scene, table_camera(), o);
  for (const int threads : {2, 5}) {
    o.threads = threads;
    CHECK(is_identical(one.layers, render_now(scene, table_camera(), o).layers));
  }
}

TEST_CASE("kj92: the mean agrees with path") {
  const PreparedScene scene(room_with_table());
  RenderOptions o = coarse();
  o.kj92.radiosity.unshot_fraction = 0.01f;
  o.kj92.radiosity.meshing.element_size = 0.3f;
  const double mine = mean(render_now(scene, table_camera(), o).layers[0].image);
  o.method = Method::path;
  o.spp = 256;
  CHECK(mine ==
        doctest::Approx(mean(render_now(scene, table_camera(), o).layers[0].image)).epsilon(0.015));
}

TEST_CASE("kj92 --indirect none: agrees with the direct light of the fixed method") {
  const PreparedScene scene(mixed_room());
  RenderOptions o = coarse();
  o.indirect = Indirect::none;
  o.spp = 16;
  const Image mine = render_now(scene, mixed_room_camera(), o).layers[0].image;
  o.method = Method::fixed;
  const Image fixed = render_now(scene, mixed_room_camera(), o).layers[0].image;
  CHECK(mean(mine) == doctest::Approx(mean(fixed)).epsilon(0.02));
}

TEST_CASE("kj92: refinement adds rays at edges and shadow boundaries and reduces the error") {
  const PreparedScene scene(room_with_table());
  RenderOptions o = coarse();
  o.indirect = Indirect::none;
  o.aovs = {Aov::error, Aov::shadow_rays, Aov::normal};
  const auto preparation =
      prepare(scene, Method::kj92, o.kj92, Indirect::none, std::nullopt, 2, {}, never_stopped);
  o.preparation = preparation.get();
  o.spp = 1;
  o.max_spp = 32;
  const RenderResult refined = render_now(scene, table_camera(), o);
  o.max_spp = 0;
  const RenderResult plain = render_now(scene, table_camera(), o);
  const auto pixels = uint64_t(o.width) * uint64_t(o.height);
  CHECK(plain.statistics.counters.viewing_rays == pixels);
  const uint64_t rays = refined.statistics.counters.viewing_rays;
  CHECK(rays > pixels * 3 / 2);
  CHECK(rays < pixels * 20);
  // Pixels in uniform light on one surface keep their first ray, and so their value.
  size_t same = 0;
  for (size_t i = 0; i < pixels; ++i)
    same += plain.layers[0].image.pixels[i] == refined.layers[0].image.pixels[i];
  CHECK(same > pixels / 10);
  // The reference is path. For the same number of viewing rays refinement must have the lower
  // error.
  RenderOptions even = o;
  even.spp = int((rays + pixels - 1) / pixels);
  RenderOptions reference = o;
  reference.method = Method::path;
  reference.spp = 1024;
  const Image truth = render_now(scene, table_camera(), reference).layers[0].image;
  const double with = rmse(refined.layers[0].image, truth),
               without = rmse(plain.layers[0].image, truth),
               spread = rmse(render_now(scene, table_camera(), even).layers[0].image, truth);
  MESSAGE("viewing rays per pixel " << double(rays) / double(pixels) << ", error refined " << with
                                    << ", one ray " << without << ", " << even.spp
                                    << " rays everywhere " << spread);
  CHECK(with < 0.6 * without);
  CHECK(with < 1.1 * spread);
}

TEST_CASE("kj92: refinement adds no rays in uniform regions") {
  Scene s;
  add_quad(s, add_diffuse(s, Rgb{0.5f}), {Vec3{-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0}});
  add_ceiling_light(s, 3, 3, Rgb{2});
  const PreparedScene scene(std::move(s));
  RenderOptions o = coarse();
  o.max_spp = 64;
  o.spp = 1;
  const RenderResult r = render_now(scene, look_at({0, -0.1f, 1.2f}, {0, 0, 0}, {0, 1, 0}, 30), o);
  CHECK(r.statistics.counters.viewing_rays == uint64_t(o.width) * uint64_t(o.height));
}

TEST_CASE("kj92: a stop during preprocessing or rendering returns soon, with the work done") {
  const PreparedScene scene(mixed_room());
  for (const double after : {0.0, 0.15, 0.8}) {
    const bool is_rendering = after > 0.5;  // stopped by rendering progress, not by time
    StopFlag stop = after == 0;
    RenderOptions o = coarse();
    o.kj92.radiosity.meshing.element_size = after == 0.15 ? 0.05f : 0.4f;  // long preprocessing
    o.kj92.radiosity.unshot_fraction = after == 0.15 ? 1e-5f : 0.05f;
    o.spp = 1 << 16;
    o.max_spp = 1 << 17;
    double at_stop = 0;
    const ProcessorStopwatch watch;
    std::thread stopper([&] {
      if (is_rendering || stop) return;
      while (watch.seconds() < after) std::this_thread::sleep_for(std::chrono::milliseconds(5));
      at_stop = watch.seconds();
      stop = true;
    });
    const auto stop_after_a_tile = [&](double) {
      if (!is_rendering || stop) return;
      at_stop = watch.seconds();
      stop = true;
    };
    const RenderResult r = render(scene, mixed_room_camera(), o, stop_after_a_tile, stop);
    stopper.join();
    const double taken = watch.seconds() - at_stop;
    CAPTURE(after);
    CHECK(!r.is_complete);
    CHECK(taken < 5);
    REQUIRE(r.layers.size() == 1);
    CHECK(r.layers[0].image.pixels.size() == 48 * 36);
    CHECK(is_finite(r.layers[0].image));
    if (is_rendering) CHECK(mean(r.layers[0].image) > 0);
  }
  StopFlag stop = true;
  MeasureOptions m;
  m.method = Method::kj92;
  const MeasureResult r = measure(scene, {{{0, 0, 1}, {0, 0, 1}}}, m, {}, stop);
  CHECK(!r.is_complete);
  CHECK(!r.is_measured[0]);
}

TEST_CASE("kj92: crops and single pixels equal the whole picture") {
  const PreparedScene scene(room_with_table());
  RenderOptions o = coarse();
  const auto preparation =
      prepare(scene, Method::kj92, o.kj92, Indirect::automatic, std::nullopt, 2, {}, never_stopped);
  o.preparation = preparation.get();
  const Image whole = render_now(scene, table_camera(), o).layers[0].image;
  // A crop aligned with tiles is bit-identical to the whole picture.
  o.has_crop = true;
  o.crop = {16, 16, 48, 32};
  const Image part = render_now(scene, table_camera(), o).layers[0].image;
  size_t same = 0;
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 32; ++x)
      same += part.pixels[size_t(y * 32 + x)] == whole.pixels[size_t((y + 16) * 48 + x + 16)];
  CHECK(same == 16 * 32);
  for (const int max_spp : {0, 9}) {
    o.max_spp = max_spp;
    o.crop = {47, 35, 48, 36};
    const Image corner = render_now(scene, table_camera(), o).layers[0].image;
    CHECK(corner.pixels.size() == 1);
    CHECK(corner.pixels[0].g == doctest::Approx(whole.pixels.back().g).epsilon(0.3));
    RenderOptions tiny = o;
    tiny.has_crop = false;
    tiny.width = tiny.height = 1;
    const RenderResult r = render_now(scene, table_camera(), tiny);
    CHECK(is_finite(r.layers[0].image));
    CHECK(mean(r.layers[0].image) > 0);
  }
}

TEST_CASE("kj92: scenes without light, without geometry or out of view") {
  Scene dark = room_with_table();
  dark.lights.clear();
  for (Mesh& m : dark.meshes) m.lights.clear();
  Scene only_light;
  add_ceiling_light(only_light, 1, 2, Rgb{5});
  for (const int max_spp : {0, 8}) {
    RenderOptions o = coarse();
    o.max_spp = max_spp;
    const auto picture = [&](Scene s, const Camera& camera) {
      const PreparedScene scene(std::move(s));
      const RenderResult r = render_now(scene, camera, o);
      CHECK(r.is_complete);
      CHECK(r.statistics.counters.nan_samples == 0);
      return mean(r.layers[0].image);
    };
    CHECK(picture(dark, table_camera()) == 0);
    CHECK(picture(Scene{}, table_camera()) == 0);
    CHECK(picture(room_with_table(), look_at({0, 0, 9}, {0, 0, 20}, {0, 1, 0}, 50)) == 0);
    CHECK(picture(only_light, look_at({0, 0, 0}, {0, 0, 2}, {0, 1, 0}, 20)) == doctest::Approx(5));
  }
}

TEST_CASE("kj92: sources far apart in size, rooms of a millimetre and of a kilometre") {
  double first = 0;
  for (const float scale : {1e-3f, 1.0f, 1e3f}) {
    Scene s = room_with_table();
    for (Mesh& m : s.meshes)
      for (Vec3& p : m.positions) p = p * scale;
    for (Light& e : s.lights)
      for (Vec3& p : e.polygon) p = p * scale;
    const PreparedScene scene(std::move(s));
    Camera camera = table_camera();
    camera.position = camera.position * scale;
    RenderOptions o = coarse();
    o.kj92.radiosity.meshing.element_size *= scale;
    o.kj92.radiosity.meshing.patch_size *= scale;
    const double m = mean(render_now(scene, camera, o).layers[0].image);
    if (first == 0) first = m;
    CHECK(m == doctest::Approx(first).epsilon(0.01));
  }
}

TEST_CASE("kj92: a light that touches a wall has no worse pixels than path's") {
  Scene s;
  add_box_inside(s, add_diffuse(s, Rgb{0.5f}), {-1, -1, 0}, {1, 1, 2});
  // One light stands on the floor's edge against the wall, another lies in the wall's plane.
  const uint32_t black = add_diffuse(s, Rgb{0});
  make_light(s,
             add_quad(s, black,
                      {Vec3{-0.5f, 0.6f, 0}, {-0.5f, 1, 0}, {-0.5f, 1, 0.5f}, {-0.5f, 0.6f, 0.5f}}),
             Rgb{5}, true);
  make_light(s,
             add_quad(s, black, {Vec3{0.2f, 1, 0.5f}, {0.2f, 1, 1}, {0.6f, 1, 1}, {0.6f, 1, 0.5f}}),
             Rgb{5}, true);
  const PreparedScene scene(std::move(s));
  RenderOptions o = coarse();
  o.indirect = Indirect::none;
  const Camera camera = look_at({0.2f, -0.6f, 1}, {-0.2f, 1, 0.4f}, {0, 0, 1}, 60);
  const RenderResult mine = render_now(scene, camera, o);
  RenderOptions p = o;
  p.method = Method::path;
  const Image path = render_now(scene, camera, p).layers[0].image;
  p.spp = 512;
  const Image truth = render_now(scene, camera, p).layers[0].image;
  CHECK(mine.statistics.counters.nan_samples == 0);
  CHECK(mean(mine.layers[0].image) == doctest::Approx(mean(truth)).epsilon(0.02));
  double worst = 0, worst_path = 0;
  for (size_t i = 0; i < truth.pixels.size(); ++i) {
    worst = std::max(worst, double(mine.layers[0].image.pixels[i].g - truth.pixels[i].g));
    worst_path = std::max(worst_path, double(path.pixels[i].g - truth.pixels[i].g));
  }
  MESSAGE("error kj92 " << rmse(mine.layers[0].image, truth) << " (worst " << worst << "), path "
                        << rmse(path, truth) << " (worst " << worst_path << ")");
  CHECK(worst < 5 * worst_path + 0.1);
}

TEST_CASE(
    "kj92room: source D is sampled on the floor under the table and only probed on open floor") {
  const std::string file = std::string(TROFFER_SOURCE_DIR) + "/scenes/kj92room/kj92room_full.pbrt";
  if (!std::filesystem::exists(file)) {
    MESSAGE("no scene " << file);
    return;
  }
  const PreparedScene scene(import_scene(file));
  Kj92Settings settings;
  settings.radiosity.unshot_fraction = 0.5f;
  settings.radiosity.meshing.element_size = 0.4f;
  settings.radiosity.meshing.patch_size = 0.8f;
  const auto p = prepare(scene, Method::kj92, settings, Indirect::automatic, std::nullopt, 2, {},
                         never_stopped);
  // Returns how source `name` is treated at the floor's point below (x, y).
  const auto treatment_at = [&](float x, float y, uint32_t source) {
    const RadiosityMesh& mesh = p->solution.mesh;
    uint32_t best = no_point;
    float nearest = 1e9f;
    for (uint32_t i = 0; i < mesh.points.size(); ++i) {
      const ElementPoint& e = mesh.points[i];
      if (std::abs(e.position.z) > 1e-4f || e.normal.z < 0.9f) continue;
      const float d = std::hypot(e.position.x - x, e.position.y - y);
      if (d < nearest) nearest = d, best = i;
    }
    REQUIRE(best != no_point);
    for (const TreatedSource& t : p->selection.of_patch(mesh.points[best].patch))
      if (t.source == source) return t.source_class.treatment;
    return SourceTreatment::general;
  };
  uint32_t d = no_source;  // the largest, on the ceiling
  for (uint32_t e = 0; e < scene.scene.lights.size(); ++e)
    if (scene.scene.lights[e].polygon.size() == 4 && scene.scene.lights[e].polygon[0].z > 2.9f)
      d = e;
  REQUIRE(d != no_source);
  CHECK(treatment_at(1.36f, 2.8f, d) == SourceTreatment::sampled);  // at a back leg
  CHECK(treatment_at(2, 2, d) == SourceTreatment::sampled);         // the table's front edge
  CHECK(treatment_at(2, 0.4f, d) == SourceTreatment::probed);       // far in front of it
}
