// Renderings that end by a time limit or an error limit.
#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>

#include "base/deadline.h"
#include "render/checkpoint.h"
#include "render/pictures.h"

using namespace troffer;
using namespace troffer::test;

namespace {

RenderOptions options_for(Method method) {
  RenderOptions o;
  o.method = method;
  o.width = 48;
  o.height = 36;
  o.aovs = {Aov::error, Aov::depth};
  o.kj92.radiosity.meshing.element_size = 0.4f;
  o.kj92.radiosity.meshing.patch_size = 1.2f;
  o.kj92.radiosity.unshot_fraction = 0.05f;
  return o;
}

const RenderResult& mixed_room_by_paths() {
  static const RenderResult result = [] {
    const PreparedScene scene(mixed_room());
    RenderOptions o = options_for(Method::path);
    o.spp = 1024;
    return render_now(scene, mixed_room_camera(), o);
  }();
  return result;
}

size_t black_pixels(const Image& image) {
  size_t n = 0;
  for (const Rgb& p : image.pixels) n += p.is_black() ? 1 : 0;
  return n;
}

// Returns the root mean square of layer `error` over the picture.
double rms_told(const RenderResult& r) {
  double sum = 0;
  for (const Rgb& p : r.layers[1].image.pixels) sum += double(sqr(p.r));
  return std::sqrt(sum / double(r.layers[1].image.pixels.size()));
}

}  // namespace

TEST_CASE("a picture with zero time is complete, has the right mean, and reports its error") {
  const PreparedScene scene(mixed_room());
  const RenderResult& reference = mixed_room_by_paths();
  for (const Method method : {Method::path, Method::certified, Method::kj92}) {
    CAPTURE(std::string(method.row().name));
    RenderOptions o = options_for(method);
    o.spp = 1 << 16;
    o.max_spp = 1 << 16;
    const StopFlag stop = false;
    Deadline deadline(stop, Deadline::Clock::now());
    o.deadline = &deadline;
    const RenderResult r = render(scene, mixed_room_camera(), o, {}, deadline.flag());
    CHECK(r.end == RenderEnd::out_of_time);
    CHECK(!r.is_complete);
    CHECK(r.statistics.gaps_filled == 48 * 36);
    CHECK(black_pixels(r.layers[0].image) < 48 * 36 / 50);
    CHECK(mean(r.layers[0].image) == doctest::Approx(mean(reference.layers[0].image)).epsilon(0.1));
    double sum = 0;
    for (size_t i = 0; i < 48 * 36; ++i)
      sum += double(sqr(luminance(r.layers[0].image.pixels[i]) -
                        luminance(reference.layers[0].image.pixels[i])));
    const double made = std::sqrt(sum / (48 * 36));
    CHECK(rms_told(r) > 0.7 * made);
    CHECK(rms_told(r) < 2 * made);
    for (size_t i = 0; i < 48 * 36; i += 97)
      CHECK(r.layers[2].image.pixels[i].r ==
            doctest::Approx(reference.layers[2].image.pixels[i].r).epsilon(0.3));
  }
}

TEST_CASE("a time limit that is not reached changes nothing; a stop is no time limit") {
  const PreparedScene scene(mixed_room());
  for (const Method method : {Method::fixed, Method::certified}) {
    RenderOptions o = options_for(method);
    o.error = 0.05;
    const RenderResult plain = render_now(scene, mixed_room_camera(), o);
    StopFlag stop = false;
    Deadline deadline(stop, Deadline::Clock::now() + std::chrono::hours(100));
    o.deadline = &deadline;
    const RenderResult r = render(scene, mixed_room_camera(), o, {}, deadline.flag());
    CHECK(r.end == RenderEnd::complete);
    CHECK(is_identical(r.layers, plain.layers));
    stop = true;
    while (!deadline.flag().load()) std::this_thread::yield();
    CHECK(render(scene, mixed_room_camera(), o, {}, deadline.flag()).end == RenderEnd::stopped);
  }
}

TEST_CASE("an unfinished picture keeps its pixels; only the rest is filled") {
  const PreparedScene scene(mixed_room());
  RenderOptions o = options_for(Method::fixed);
  o.threads = 1;
  const RenderResult plain = render_now(scene, mixed_room_camera(), o);
  const StopFlag stop = false;
  Deadline deadline(stop, Deadline::Clock::now() + std::chrono::hours(100));
  o.deadline = &deadline;
  // The time ends suddenly half-way.
  const ProgressCallback progress = [&](double share) {
    if (share < 0.5) return;
    deadline.keep_back(1e9);
    while (!deadline.flag().load()) std::this_thread::yield();
  };
  const RenderResult r = render(scene, mixed_room_camera(), o, progress, deadline.flag());
  CHECK(r.end == RenderEnd::out_of_time);
  CHECK(r.statistics.share_done >= 0.5);
  CHECK(r.statistics.share_done < 0.7);
  size_t same = 0;
  for (size_t i = 0; i < 48 * 36; ++i)
    same += r.layers[0].image.pixels[i] == plain.layers[0].image.pixels[i] ? 1 : 0;
  CHECK(r.statistics.gaps_filled > 0);
  CHECK(same >= 48 * 36 - r.statistics.gaps_filled);
  CHECK(black_pixels(r.layers[0].image) < 48 * 36 / 20);
}

TEST_CASE(
    "a time limit after cells are made gives a picture by cells, better than by as many paths") {
  const PreparedScene scene(mixed_room());
  const RenderResult& reference = mixed_room_by_paths();
  RenderOptions o = options_for(Method::certified);
  o.indirect = Indirect::cells;
  o.error = 0.05;
  // Root of the mean square difference in luminance, without the brightest pixels: edges of lamps.
  const auto actual_error = [&](const RenderResult& r) {
    std::vector<double> squares;
    for (size_t i = 0; i < 48 * 36; ++i)
      squares.push_back(double(sqr(luminance(r.layers[0].image.pixels[i]) -
                                   luminance(reference.layers[0].image.pixels[i]))));
    std::sort(squares.begin(), squares.end());
    squares.resize(squares.size() * 9 / 10);
    return std::sqrt(std::accumulate(squares.begin(), squares.end(), 0.0) / double(squares.size()));
  };
  const auto ended_at = [&](double share) {
    const StopFlag stop = false;
    Deadline deadline(stop, Deadline::Clock::now() + std::chrono::hours(100));
    o.deadline = &deadline;
    const RenderResult r = render(
        scene, mixed_room_camera(), o,
        [&](double done) {
          if (done < share) return;
          deadline.keep_back(1e9);
          while (!deadline.flag().load()) std::this_thread::yield();
        },
        deadline.flag());
    CHECK(r.end == RenderEnd::out_of_time);
    CHECK(r.statistics.gaps_filled == 48 * 36);
    CHECK(r.statistics.estimated_error > 0);
    CHECK(mean(r.layers[0].image) ==
          doctest::Approx(mean(reference.layers[0].image)).epsilon(0.05));
    return r;
  };
  // Half of the progress is preparation: two fifths of that for cells, the rest for gathering.
  const RenderResult by_paths = ended_at(0.05), by_cells = ended_at(0.25);
  CHECK(by_paths.statistics.gaps_are_paths);
  CHECK(!by_cells.statistics.gaps_are_paths);
  CHECK(actual_error(by_cells) < 0.65 * actual_error(by_paths));  // for equal numbers of samples
}

TEST_CASE(
    "an error limit ends the work when the estimated error reaches it, for any number of threads") {
  const PreparedScene scene(mixed_room());
  for (const Method method : {Method::path, Method::fixed, Method::certified}) {
    CAPTURE(std::string(method.row().name));
    RenderOptions o = options_for(method);
    o.spp = method == Method::certified ? 4 : 1024;
    o.error = 0.05;
    const RenderResult first = [&] {
      RenderOptions few = o;
      few.spp = few.max_spp = 4;
      return render_now(scene, mixed_room_camera(), few);
    }();
    o.error_limit = method == Method::certified ? 0.9 * first.statistics.estimated_error
                                                : 0.25 * first.statistics.estimated_error;
    o.threads = 1;
    const RenderResult r = render_now(scene, mixed_room_camera(), o);
    CHECK(r.end == RenderEnd::good_enough);
    CHECK(r.is_complete);
    CHECK(r.statistics.estimated_error <= o.error_limit);
    CHECK(r.statistics.estimated_error > 0.3 * o.error_limit);
    CHECK(rms_told(r) > 0);
    RenderOptions all = o;
    all.error_limit = 0;
    if (method == Method::certified)
      CHECK(render_now(scene, mixed_room_camera(), all).statistics.counters.viewing_rays >
            r.statistics.counters.viewing_rays);
    o.threads = 3;
    CHECK(is_identical(r.layers, render_now(scene, mixed_room_camera(), o).layers));
  }
}
