// Pictures do not depend on threads, tiles or crops; also stops, progress, layers.
#include "render/render.h"

#include <doctest/doctest.h>

#include <atomic>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "pictures.h"
#include "support/abort_message.h"

using namespace troffer;
using namespace troffer::test;

namespace {

const std::vector<Aov> all_aovs{Aov::albedo, Aov::normal,   Aov::depth,       Aov::position,
                                Aov::direct, Aov::indirect, Aov::shadow_rays, Aov::error};

RenderOptions small_options(Method method) {
  RenderOptions o;
  o.method = method;
  o.width = 53;
  o.height = 37;
  o.spp = method == Method::path ? 19 : 3;  // more than one pass, and not a power of two
  o.shadow_rays = 5;
  o.aovs = all_aovs;
  return o;
}

}  // namespace

TEST_CASE("the same picture, bit for bit, on 1, 2 and 5 threads") {
  const PreparedScene scene(mixed_room());
  for (const Method method : {Method::path, Method::fixed}) {
    RenderOptions o = small_options(method);
    o.threads = 1;
    const RenderResult one = render_now(scene, mixed_room_camera(), o);
    CHECK(one.is_complete);
    CHECK(one.layers.size() == 1 + all_aovs.size());
    CHECK(one.statistics.counters.viewing_rays == uint64_t(53 * 37 * o.spp));
    for (const int threads : {2, 5}) {
      o.threads = threads;
      const RenderResult many = render_now(scene, mixed_room_camera(), o);
      CHECK(is_identical(one.layers, many.layers));
      CHECK(one.statistics.counters.shadow_rays == many.statistics.counters.shadow_rays);
    }
  }
}

TEST_CASE("a crop holds the same pixels as the whole picture") {
  const PreparedScene scene(mixed_room());
  for (const Method method : {Method::path, Method::fixed}) {
    RenderOptions o = small_options(method);
    const RenderResult whole = render_now(scene, mixed_room_camera(), o);
    o.has_crop = true;
    for (const auto& crop : {std::array<int, 4>{5, 3, 40, 31}, {0, 0, 1, 1}, {52, 36, 53, 37}}) {
      o.crop = crop;
      const RenderResult part = render_now(scene, mixed_room_camera(), o);
      CHECK(part.statistics.width == crop[2] - crop[0]);
      CHECK(pixels_off_crop(whole, part, crop) == 0);
    }
  }
}

TEST_CASE("every method refines the picture where it differs from its neighbours, also in a crop") {
  const PreparedScene scene(mixed_room());
  for (const Method method : {Method::path, Method::fixed}) {
    RenderOptions o = small_options(method);
    o.aovs = {Aov::direct, Aov::indirect};
    o.spp = 4;
    const RenderResult plain = render_now(scene, mixed_room_camera(), o);
    o.max_spp = 24;
    o.threads = 1;
    const RenderResult refined = render_now(scene, mixed_room_camera(), o);
    const auto rays = [](const RenderResult& r) { return r.statistics.counters.viewing_rays; };
    CAPTURE(std::string(method.row().name));
    CHECK(rays(plain) == 53 * 37 * 4);
    CHECK(rays(refined) > rays(plain));
    CHECK(rays(refined) <= 53 * 37 * 24);
    if (method == Method::fixed) CHECK(rays(refined) < 53 * 37 * 24);  // uniform regions stay
    o.threads = 3;
    CHECK(is_identical(render_now(scene, mixed_room_camera(), o).layers, refined.layers));
    o.has_crop = true;
    o.crop = {7, 9, 31, 20};
    CHECK(pixels_off_crop(refined, render_now(scene, mixed_room_camera(), o), o.crop) == 0);
    RenderOptions many = small_options(method);
    many.spp = 256;
    many.seed = 9;
    const RenderResult right = render_now(scene, mixed_room_camera(), many);
    const auto error = [&](const RenderResult& r) {
      double sum = 0;
      for (size_t i = 0; i < right.layers[0].image.pixels.size(); ++i)
        sum += double(sqr(r.layers[0].image.pixels[i].g - right.layers[0].image.pixels[i].g));
      return std::sqrt(sum);
    };
    CHECK(error(refined) < 0.8 * error(plain));
  }
}

TEST_CASE("crops that are empty or reach outside are refused") {
  const PreparedScene scene(mixed_room());
  RenderOptions o = small_options(Method::path);
  o.has_crop = true;
  for (const auto& crop : {std::array<int, 4>{0, 0, 54, 37},
                           {-1, 0, 5, 5},
                           {5, 5, 5, 9},
                           {9, 5, 5, 9},
                           {0, 0, std::numeric_limits<int>::max(), 5}}) {
    o.crop = crop;
    CHECK_THROWS_AS(render_now(scene, mixed_room_camera(), o), UsageError);
  }
}

TEST_CASE("cameras whose numbers overflow are refused") {
  const PreparedScene scene(mixed_room());
  const RenderOptions o = small_options(Method::path);
  Camera far = mixed_room_camera();
  far.position = Vec3{1e30f};
  CHECK_THROWS_AS(render_now(scene, far, o), InputError);
  Camera undirected = mixed_room_camera();
  undirected.forward = Vec3{std::nanf("")};
  CHECK_THROWS_AS(render_now(scene, undirected, o), InputError);
}

TEST_CASE("the seed changes the noise, not the mean") {
  const PreparedScene scene(mixed_room());
  RenderOptions o = small_options(Method::path);
  const RenderResult a = render_now(scene, mixed_room_camera(), o);
  CHECK(is_identical(a.layers, render_now(scene, mixed_room_camera(), o).layers));
  o.seed = 1;
  const RenderResult b = render_now(scene, mixed_room_camera(), o);
  size_t same = 0;
  for (size_t i = 0; i < a.layers[0].image.pixels.size(); ++i)
    same += a.layers[0].image.pixels[i] == b.layers[0].image.pixels[i];
  CHECK(same < a.layers[0].image.pixels.size() / 10);
  CHECK(mean(a.layers[0].image) == doctest::Approx(mean(b.layers[0].image)).epsilon(0.05));
}

TEST_CASE("direct and indirect light add up to the picture") {
  const PreparedScene scene(mixed_room());
  RenderOptions o = small_options(Method::path);
  const RenderResult r = render_now(scene, mixed_room_camera(), o);
  const Image &whole = r.layers[0].image, &direct = r.layers[5].image,
              &indirect = r.layers[6].image;
  REQUIRE(r.layers[5].name == "direct");
  REQUIRE(r.layers[6].name == "indirect");
  for (size_t i = 0; i < whole.pixels.size(); ++i)
    for (size_t c = 0; c < 3; ++c)
      REQUIRE(std::abs(direct.pixels[i][c] + indirect.pixels[i][c] - whole.pixels[i][c]) <=
              4e-7f * whole.pixels[i][c]);
  CHECK(mean(direct) > 0);
  CHECK(mean(indirect) > 0);
  o.indirect = Indirect::none;
  const RenderResult none = render_now(scene, mixed_room_camera(), o);
  CHECK(mean(none.layers[6].image) == 0);
  CHECK(mean(none.layers[0].image) == doctest::Approx(mean(direct)).epsilon(0.03));
}

TEST_CASE("light by depth adds up pixel by pixel to the whole") {
  const PreparedScene scene(mixed_room());
  RenderOptions o;
  o.method = Method::path;
  o.width = 24;
  o.height = 18;
  o.spp = 64;
  std::vector<double> means;
  for (const int depth : {0, 1, 2, 4, 30, -1}) {
    o.depth = depth;
    const Image image = render_now(scene, mixed_room_camera(), o).layers[0].image;
    REQUIRE(is_finite(image));
    means.push_back(mean(image));
  }
  for (size_t i = 1; i + 2 < means.size(); ++i) CHECK(means[i] > means[i - 1]);
  CHECK(means[4] == doctest::Approx(means[5]).epsilon(0.01));
}

TEST_CASE("layers have their documented meaning") {
  const PreparedScene scene(mixed_room());
  const Camera camera = mixed_room_camera();
  RenderOptions o = small_options(Method::path);
  const RenderResult r = render_now(scene, camera, o);
  const ViewingCamera view(camera, o.width, o.height);
  const Image &albedo = r.layers[1].image, &normal = r.layers[2].image, &depth = r.layers[3].image,
              &position = r.layers[4].image, &shadow_rays = r.layers[7].image,
              &error = r.layers[8].image;
  for (size_t i = 0; i < normal.pixels.size(); ++i) {
    const Rgb n = normal.pixels[i], p = position.pixels[i];
    REQUIRE(std::sqrt(n.r * n.r + n.g * n.g + n.b * n.b) == doctest::Approx(1).epsilon(1e-5));
    REQUIRE(depth.pixels[i].r ==
            doctest::Approx(double(view.depth({p.r, p.g, p.b}))).epsilon(1e-4));
    for (size_t c = 0; c < 3; ++c) {
      REQUIRE(albedo.pixels[i][c] >= 0);
      REQUIRE(albedo.pixels[i][c] <= 1.001f);
    }
    REQUIRE(shadow_rays.pixels[i].r >= 0);
    REQUIRE(std::isfinite(error.pixels[i].r));
    REQUIRE(error.pixels[i].r >= 0);
  }
}

TEST_CASE("the error layer is the spread of pictures with other seeds") {
  const PreparedScene scene(mixed_room());
  RenderOptions o;
  o.method = Method::path;
  o.width = 24;
  o.height = 18;
  o.spp = 16;
  o.aovs = {Aov::error};
  // Stratified samples err less than independent ones, for which the layer stands. The actual error
  // must lie below, but not far below.
  const Ensemble e = render_ensemble(scene, mixed_room_camera(), o, 24);
  double claimed = 0, true_variance = 0;
  for (uint64_t seed = 0; seed < 8; ++seed) {
    o.seed = seed;
    const RenderResult result = render_now(scene, mixed_room_camera(), o);
    for (const Rgb& p : result.layers[1].image.pixels) claimed += double(p.r) * double(p.r) / 8;
  }
  for (const Moments& m : e.pixels) true_variance += m.variance_of_mean() * 24;
  CHECK(claimed > 0.9 * true_variance);
  CHECK(claimed < 10 * true_variance);
}

TEST_CASE("progress rises to one, one call at a time") {
  const PreparedScene scene(mixed_room());
  RenderOptions o = small_options(Method::path);
  o.threads = 3;
  double last = 0;
  bool is_monotone = true;
  std::atomic<int> inside = 0;
  bool is_alone = true;
  render(
      scene, mixed_room_camera(), o,
      [&](double f) {
        is_alone = is_alone && inside.fetch_add(1) == 0;
        is_monotone = is_monotone && f >= last && f <= 1;
        last = f;
        --inside;
      },
      never_stopped);
  CHECK(is_monotone);
  CHECK(is_alone);
  CHECK(last == 1);
}

TEST_CASE("after a stop every pixel is the mean of its samples so far") {
  // All surfaces are black and emit 2, so any sample is exactly 2.
  Scene s;
  const uint32_t black = add_diffuse(s, Rgb{0});
  for (const uint32_t q : add_box_inside(s, black, {-1, -1, -1}, {1, 1, 1}))
    make_light(s, q, Rgb{2});
  const PreparedScene scene(std::move(s));
  RenderOptions o = small_options(Method::path);
  o.spp = 64;
  for (const double when : {0.01, 0.5}) {
    StopFlag stop = false;
    const RenderResult r = render(
        scene, look_at({0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 60), o,
        [&](double f) { stop = stop || f > when; }, stop);
    CHECK_FALSE(r.is_complete);
    size_t lit = 0;
    for (const Rgb& p : r.layers[0].image.pixels) {
      REQUIRE((p == Rgb{2} || p == Rgb{0}));
      lit += p == Rgb{2};
    }
    CHECK(lit > 0);
    if (when < 0.1) CHECK(lit < r.layers[0].image.pixels.size());
    CHECK(r.layers.size() == 1 + all_aovs.size());
    CHECK(r.statistics.counters.viewing_rays < uint64_t(53 * 37 * 64));
    CHECK(r.statistics.counters.viewing_rays >= lit);
  }
  const StopFlag stopped = true;
  const RenderResult nothing =
      render(scene, look_at({0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 60), o, {}, stopped);
  CHECK_FALSE(nothing.is_complete);
  CHECK(mean(nothing.layers[0].image) == 0);
}

TEST_CASE("NaN light never reaches the picture") {
  for (const float bad : {std::nanf(""), std::numeric_limits<float>::infinity()}) {
    Scene s = mixed_room();
    make_light(s,
               add_quad(s, 0, {Vec3{-1.9f, -1, 1}, {-1.9f, 1, 1}, {-1.9f, 1, 2}, {-1.9f, -1, 2}}),
               Rgb{bad, 1, 1});
    const PreparedScene scene(std::move(s));
    for (const Method method : {Method::path, Method::fixed}) {
      RenderOptions o = small_options(method);
      const RenderResult r = render_now(scene, mixed_room_camera(), o);
      for (const Layer& l : r.layers) CHECK(is_finite(l.image));
      CHECK(mean(r.layers[0].image) > 0);
    }
  }
}

TEST_CASE("empty scenes and scenes without light are black") {
  Scene lightless;
  add_box_inside(lightless, add_diffuse(lightless, Rgb{0.9f}), {-1, -1, -1}, {1, 1, 1});
  const PreparedScene scenes[] = {PreparedScene(Scene{}), PreparedScene(std::move(lightless))};
  for (const PreparedScene& scene : scenes)
    for (const Method method : {Method::path, Method::fixed}) {
      RenderOptions o = small_options(method);
      const RenderResult r = render_now(scene, look_at({0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 60), o);
      CHECK(r.is_complete);
      CHECK(mean(r.layers[0].image) == 0);
      for (const Layer& l : r.layers) CHECK(is_finite(l.image));
    }
}

TEST_CASE("a broken CHECK names the pixel and the sample under way") {
  const PreparedScene scene(mixed_room());
  RenderOptions o = small_options(Method::fixed);
  o.has_crop = true;
  o.crop = {20, 11, 21, 12};
  o.spp = 1;
  o.threads = 1;
  const std::string message = abort_message([&] {
    // called at the end of each batch
    const ProgressCallback broken = [](double share) { TROFFER_CHECK(share < 0); };
    render(scene, mixed_room_camera(), o, broken, never_stopped);
  });
  CHECK(message.find("at pixel (20,11), sample 0\n") != std::string::npos);
}
