// Progressive pictures of a room in memory: the final layers are compared with renderings.
#include <doctest/doctest.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <thread>

#include "base/error.h"
#include "support/scenes.h"
#include "view/dimmed.h"
#include "view/measuring_queue.h"
#include "view/painter.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// A closed room of 4 × 4 × 3 m with a block in it and two lights below the ceiling.
Scene room() {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.6f});
  add_box_inside(s, grey, {0, 0, 0}, {4, 4, 3});
  add_quad(s, grey, {Vec3{1.5f, 1.5f, 1}, {2.5f, 1.5f, 1}, {2.5f, 2.5f, 1}, {1.5f, 2.5f, 1}});
  for (const float x : {0.5f, 2.5f}) {
    const uint32_t light = add_quad(
        s, grey, {Vec3{x, 1.5f, 2.9f}, {x, 2.5f, 2.9f}, {x + 1, 2.5f, 2.9f}, {x + 1, 1.5f, 2.9f}});
    make_light(s, light, x < 1 ? Rgb{4, 4, 4} : Rgb{2, 3, 4});
  }
  return s;
}

ViewRequest request_of(const std::shared_ptr<Lighting>& lighting) {
  return {lighting, look_at({0.3f, 0.3f, 1.6f}, {3, 3, 1}, {0, 0, 1}, 70), {48, 36}};
}

RenderOptions options() {
  RenderOptions o;
  o.error = 0.05;
  o.threads = 2;
  return o;
}

void wait_until(const std::function<bool()>& is_done) {
  for (int i = 0; i < 120'000 && !is_done(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  REQUIRE(is_done());
}

double mean_of(const Image& image) {
  double sum = 0;
  for (const Rgb& p : image.pixels) sum += double(luminance(p));
  return sum / double(image.pixels.size());
}

double rms_difference(const Image& a, const Image& b) {
  REQUIRE(a.pixels.size() == b.pixels.size());
  double sum = 0;
  for (size_t i = 0; i < a.pixels.size(); ++i)
    sum += sqr(double(luminance(a.pixels[i])) - double(luminance(b.pixels[i])));
  return std::sqrt(sum / double(a.pixels.size())) / mean_of(b);
}

}  // namespace

TEST_CASE("layers of single luminaires add up to the picture of all, after any camera move") {
  const auto lighting = std::make_shared<Lighting>(room());
  LayerBoard board;
  Painter painter(board, options());
  painter.show(request_of(lighting));
  // Successive moves: each view, or a later one, gets a picture.
  ViewRequest request = request_of(lighting);
  uint64_t view = 0;
  for (int i = 0; i < 5; ++i) {
    request.camera.position.x += 0.1f;
    view = painter.show(request);
  }
  wait_until([&] { return painter.state().view == view && painter.state().stage == "done"; });
  painter.set_extras({{Rgb{1}, Rgb{0.5f}}, Method::path});
  wait_until([&] {
    const auto l = board.get("second");
    return painter.state().stage == "done" && l && l->error > 0;
  });
  CHECK(painter.state().seconds_to_first > 0);
  CHECK(painter.state().failure.empty());
  const Image whole = board.get("whole")->image;
  CHECK(whole.width == 48);
  CHECK(board.get("whole")->view == view);
  CHECK(board.get("whole")->error > 0);
  CHECK(board.get("whole")->error < 0.05);
  Image sum = dimmed_picture(board, {Rgb{1}, Rgb{0.999f}});
  CHECK(rms_difference(sum, whole) < 0.06);
  CHECK(mean_of(sum) == doctest::Approx(mean_of(whole)).epsilon(0.01));
  // With one light off the picture is darker by its contribution.
  CHECK(mean_of(dimmed_picture(board, {Rgb{1}, Rgb{0}})) < 0.8 * mean_of(whole));
  CHECK(rms_difference(board.get("second")->image, whole) < 0.2);
  CHECK(mean_of(board.get("second")->image) == doctest::Approx(mean_of(whole)).epsilon(0.01));
  // The same picture as by a separate rendering.
  RenderOptions o = options();
  o.width = 48;
  o.height = 36;
  const StopFlag never = false;
  const Image own = render(*lighting->whole(), request.camera, o, nullptr, never).layers[0].image;
  CHECK(rms_difference(whole, own) < 0.06);
  CHECK(mean_of(whole) == doctest::Approx(mean_of(own)).epsilon(0.01));
}

TEST_CASE("with dimmers set, the first picture after a move shows the settings") {
  const auto lighting = std::make_shared<Lighting>(room());
  LayerBoard board;
  Painter painter(board, options());
  ViewRequest request = request_of(lighting);
  painter.show(request);
  wait_until([&] { return painter.state().stage == "done"; });
  painter.set_extras({{Rgb{1}, Rgb{0}}, std::nullopt});
  wait_until([&] { return board.get("dimmed") != nullptr; });
  wait_until([&] { return painter.state().stage == "done"; });
  const double expected = mean_of(dimmed_picture(board, {Rgb{1}, Rgb{0}}));
  CHECK(expected < 0.8 * mean_of(board.get("whole")->image));
  CHECK(mean_of(board.get("dimmed")->image) == doctest::Approx(expected).epsilon(0.1));
  // With all layers present, the page adds up new settings itself and nothing is rendered.
  const uint64_t version = board.get("dimmed")->version;
  painter.set_extras({{Rgb{1}, Rgb{0.5f}}, std::nullopt});
  request.camera.position.x += 0.1f;
  const uint64_t view = painter.show(request);
  wait_until([&] { return board.get("dimmed")->view == view; });
  CHECK(board.get("dimmed")->version > version);
  wait_until([&] { return painter.state().view == view && painter.state().stage == "done"; });
  CHECK(mean_of(board.get("dimmed")->image) ==
        doctest::Approx(mean_of(dimmed_picture(board, {Rgb{1}, Rgb{0.5f}}))).epsilon(0.1));
}

TEST_CASE("a dimmed scene that shares the tracer renders like an independent one") {
  const auto lighting = std::make_shared<Lighting>(room());
  const auto shared = lighting->dimmed({Rgb{0.5f, 0.25f, 1}, Rgb{0}});
  Scene own = room();
  own.lights[0].radiance = own.lights[0].radiance * Rgb{0.5f, 0.25f, 1};
  own.lights[1].radiance = Rgb{0};
  RenderOptions o = options();
  o.width = 24;
  o.height = 18;
  const StopFlag never = false;
  const Camera camera = request_of(lighting).camera;
  const Image a = render(*shared, camera, o, nullptr, never).layers[0].image;
  const Image b = render(PreparedScene(std::move(own)), camera, o, nullptr, never).layers[0].image;
  CHECK(a.pixels == b.pixels);
}

TEST_CASE("changed light on stored cells gives the same picture as a new start") {
  LayerBoard board;
  Painter painter(board, options());
  painter.show(request_of(std::make_shared<Lighting>(room())));
  wait_until([&] { return painter.state().stage == "done"; });
  const double before = mean_of(board.get("whole")->image);
  Scene turned = room();
  turned.lights[0].radiance = Rgb{1, 0, 2};
  turned.lights[1].radiance = Rgb{0, 2, 0};
  const auto lighting = std::make_shared<Lighting>(std::move(turned));
  const uint64_t view = painter.show(request_of(lighting));
  wait_until([&] { return painter.state().view == view && painter.state().stage == "done"; });
  LayerBoard fresh_board;
  Painter fresh(fresh_board, options());
  fresh.show(request_of(lighting));
  wait_until([&] { return fresh.state().stage == "done"; });
  const Image after = board.get("whole")->image;
  CHECK(mean_of(after) == doctest::Approx(mean_of(fresh_board.get("whole")->image)).epsilon(0.01));
  CHECK(std::abs(mean_of(after) - before) > 0.1 * before);
}

TEST_CASE("an unusable camera fails alone; the next one is shown") {
  const auto lighting = std::make_shared<Lighting>(room());
  LayerBoard board;
  Painter painter(board, options());
  ViewRequest request = request_of(lighting);
  request.camera.position.x = 1e30f;
  painter.show(request);
  wait_until([&] { return !painter.state().failure.empty(); });
  const uint64_t view = painter.show(request_of(lighting));
  wait_until([&] { return painter.state().view == view && painter.state().stage == "done"; });
  CHECK(painter.state().failure.empty());
}

TEST_CASE("the painter ends at once, whatever it is doing") {
  const auto lighting = std::make_shared<Lighting>(room());
  LayerBoard board;
  RenderOptions o = options();
  o.error = 0.001;
  ViewRequest request = request_of(lighting);
  request.size = {1000, 1000};
  {
    Painter painter(board, o);
    painter.show(request);
    wait_until([&] { return board.get("whole") != nullptr; });
  }
  { const Painter never_asked(board, o); }
}

TEST_CASE("points are measured in the background, in total and by single luminaires") {
  const auto lighting = std::make_shared<Lighting>(room());
  MeasureOptions o;
  o.threads = 2;
  MeasuringQueue desk(o);
  const std::vector<MeasuringPoint> points{{{2, 0.5, 0}, {0, 0, 1}}, {{2, 2, 1}, {0, 0, 1}}};
  const uint64_t whole = desk.add({lighting, points, false});
  const uint64_t parts = desk.add({lighting, points, true});
  wait_until([&] { return desk.answer(parts)->is_done; });
  const MeasuringAnswer a = *desk.answer(whole), b = *desk.answer(parts);
  REQUIRE(a.values.size() == 1);
  REQUIRE(b.values.size() == 2);
  const auto sum = dimmed_measurements(b, {Rgb{1}, Rgb{1}});
  for (size_t i = 0; i < points.size(); ++i) {
    const Measurement& m = a.values[0][i];
    CHECK(m.illuminance_lx > 0);
    CHECK(std::abs(sum[i].illuminance_lx - m.illuminance_lx) <
          5 * std::hypot(sum[i].standard_error, m.standard_error));
  }
  CHECK(!desk.answer(999));
  CHECK_THROWS_AS(desk.add({lighting, {}, false}), UsageError);
  // still unfinished at the end
  desk.add({lighting, std::vector<MeasuringPoint>(5000, points[0]), false});
}
