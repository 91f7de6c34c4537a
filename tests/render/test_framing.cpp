// Default cameras for rooms and for objects.
#include "render/framing.h"

#include <doctest/doctest.h>

#include "render/camera.h"
#include "support/light_scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// A box of this size whose fronts face inwards (a room) or outwards (a body).
void add_box(Scene& s, const Vec3& low, const Vec3& high, bool is_room) {
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  for (size_t axis = 0; axis < 3; ++axis)
    for (const bool is_high : {false, true}) {
      const size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
      Vec3 p[4];
      for (size_t k = 0; k < 4; ++k) {
        p[k][axis] = is_high ? high[axis] : low[axis];
        p[k][u] = k == 1 || k == 2 ? high[u] : low[u];
        p[k][v] = k >= 2 ? high[v] : low[v];
      }
      if (is_high == is_room) std::swap(p[1], p[3]);
      add_quad(s, grey, {p[0], p[1], p[2], p[3]});
    }
}

}  // namespace

TEST_CASE("a room is shown from inside, an object from the front") {
  Scene room;
  add_box(room, {0, 0, 0}, {5, 3, 4}, true);
  add_box(room, {2, 0, 1}, {3, 0.8f, 2}, false);
  const PreparedScene inside(std::move(room));
  CHECK(is_room(inside));
  const Camera within = framing_camera(inside, {0, 1, 0});
  for (size_t a = 0; a < 3; ++a) {
    CHECK(within.position[a] > 0);
    CHECK(within.position[a] < Vec3{5, 3, 4}[a]);
  }

  Scene object;
  add_box(object, {-1, 0, -1}, {1, 2, 1}, false);
  const PreparedScene outside(std::move(object));
  CHECK_FALSE(is_room(outside));
  for (const Vec3 up : {Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
    const Camera c = framing_camera(outside, up);
    CHECK(dot(c.up, up) > 0.8f);
    // All corners are in the picture, and the camera is not far off.
    const ViewingCamera viewing(c, 400, 300);
    float lowest = 300, highest = 0;
    for (int i = 0; i < 8; ++i) {
      Vec2 at;
      REQUIRE(viewing.raster_of(
          {(i & 1) != 0 ? 1.0f : -1.0f, (i & 2) != 0 ? 2.0f : 0.0f, (i & 4) != 0 ? 1.0f : -1.0f},
          at));
      CHECK(at.x > 0);
      CHECK(at.x < 400);
      CHECK(at.y > 0);
      CHECK(at.y < 300);
      lowest = std::min(lowest, at.y);
      highest = std::max(highest, at.y);
    }
    CHECK(highest - lowest > 120);
  }

  // A table on a plate is not a room; an empty scene is not one either.
  Scene table;
  add_box(table, {-2, -0.1f, -2}, {2, 0, 2}, false);
  add_box(table, {-1, 0.7f, -1}, {1, 0.75f, 1}, false);
  CHECK_FALSE(is_room(PreparedScene(std::move(table))));
  CHECK_FALSE(is_room(PreparedScene(Scene())));
}

TEST_CASE("spheres count like other surfaces: balls in a room, a room that is a sphere, a ball") {
  const auto add_ball = [](Scene& s, const Vec3& centre, float radius, bool is_inside_out) {
    Sphere ball;
    ball.centre = centre;
    ball.radius = radius;
    ball.is_inside_out = is_inside_out;
    ball.material = add_diffuse(s, Rgb{0.5f});
    s.spheres.push_back(ball);
  };
  Scene balls;  // nearly all rays meet balls
  add_box(balls, {0, 0, 0}, {4, 4, 4}, true);
  for (int i = 0; i < 64; ++i)
    add_ball(balls, Vec3{float(i % 4), float(i / 4 % 4), float(i / 16)} + Vec3{0.5f}, 0.4f, false);
  CHECK(is_room(PreparedScene(std::move(balls))));
  Scene dome;
  add_ball(dome, {0, 0, 0}, 3, true);
  CHECK(is_room(PreparedScene(std::move(dome))));
  Scene ball;
  add_ball(ball, {0, 0, 0}, 3, false);
  CHECK_FALSE(is_room(PreparedScene(std::move(ball))));
}
