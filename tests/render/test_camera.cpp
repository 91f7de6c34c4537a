// Conventions of the cameras.
#include "render/camera.h"

#include <doctest/doctest.h>

#include <cmath>

#include "base/error.h"
#include "base/random.h"

using namespace troffer;

namespace {

constexpr Vec2 middle_of_lens{0.5f, 0.5f};

// Returns the angle of the ray through a raster position to the camera's axis, degrees.
double angle_deg(const Camera& camera, int width, int height, float x, float y) {
  const Ray r = ViewingCamera(camera, width, height).ray({x, y}, middle_of_lens);
  return deg_from_rad(std::acos(double(std::min(1.0f, dot(r.direction, camera.forward)))));
}

Camera with_fov(double fov_deg, bool is_vertical) {
  Camera c;
  c.half_extent = float(std::tan(rad_from_deg(fov_deg / 2)));
  c.fov_is_vertical = is_vertical;
  return c;
}

void check_close(const Vec3& a, const Vec3& b, float tolerance = 1e-5f) {
  CAPTURE(a.x);
  CAPTURE(a.y);
  CAPTURE(a.z);
  CHECK(length(a - b) <= tolerance * std::max(1.0f, length(b)));
}

}  // namespace

TEST_CASE("field of view: vertical, or over the shorter axis") {
  for (const auto& [w, h] : {std::pair{400, 200}, {200, 400}, {300, 300}}) {
    const float fw = float(w), fh = float(h);
    CHECK(angle_deg(with_fov(50, true), w, h, fw / 2, 0) == doctest::Approx(25).epsilon(1e-4));
    CHECK(angle_deg(with_fov(50, true), w, h, fw / 2, fh) == doctest::Approx(25).epsilon(1e-4));
    const Camera shorter = with_fov(50, false);
    const double side =
        w < h ? angle_deg(shorter, w, h, 0, fh / 2) : angle_deg(shorter, w, h, fw / 2, 0);
    CHECK(side == doctest::Approx(25).epsilon(1e-4));
    // Pixels are square.
    const ViewingCamera v(shorter, w, h);
    const Vec3 o = v.ray({fw / 2, fh / 2}, middle_of_lens).direction;
    const Vec3 dx = v.ray({fw / 2 + 1, fh / 2}, middle_of_lens).direction - o;
    const Vec3 dy = v.ray({fw / 2, fh / 2 + 1}, middle_of_lens).direction - o;
    CHECK(length(dx) == doctest::Approx(double(length(dy))).epsilon(1e-3));
  }
}

TEST_CASE("row 0 is on top, column 0 on the left") {
  const ViewingCamera v(with_fov(60, true), 320, 240);
  const Vec3 d = v.ray({0, 0}, middle_of_lens).direction;
  CHECK(d.x < 0);  // right is +x, up is +y, forward is -z
  CHECK(d.y > 0);
  CHECK(d.z < 0);
  check_close(v.ray({160, 120}, middle_of_lens).direction, {0, 0, -1});
  CHECK(length(d) == doctest::Approx(1).epsilon(1e-6));
}

TEST_CASE("orthographic rays are parallel and start across the image") {
  Camera c;
  c.kind = CameraKind::orthographic;
  c.position = {1, 2, 3};
  c.half_extent = 2;
  const ViewingCamera v(c, 300, 200);
  for (const Vec2 raster : {Vec2{0, 0}, {300, 0}, {150, 100}, {300, 200}}) {
    const Ray r = v.ray(raster, middle_of_lens);
    check_close(r.direction, {0, 0, -1});
    check_close(r.origin, {1 + (raster.x / 150 - 1) * 3, 2 - (raster.y / 100 - 1) * 2, 3});
  }
}

TEST_CASE("a screen window overrides the image's shape") {
  Camera c = with_fov(90, false);  // half_extent 1
  c.has_screen_window = true;
  c.screen_window = {-0.5f, 2, -1, 0.25f};
  const ViewingCamera v(c, 100, 100);
  const auto plane = [&](const Vec2& raster) {
    const Vec3 d = v.ray(raster, middle_of_lens).direction;
    return d / -d.z;
  };
  check_close(plane({0, 0}), {-0.5f, 0.25f, -1});
  check_close(plane({100, 100}), {2, -1, -1});
}

TEST_CASE("look_at is right-handed and upright") {
  const Camera c = look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 40);
  check_close(c.forward, {0, 0, -1});
  check_close(c.right, {1, 0, 0});
  check_close(c.up, {0, 1, 0});
  CHECK(angle_deg(c, 300, 200, 150, 0) == doctest::Approx(20).epsilon(1e-4));
  Random r(1);
  for (int i = 0; i < 100; ++i) {
    const auto point = [&] { return Vec3{r.next_float(), r.next_float(), r.next_float()}; };
    const Camera d = look_at(point(), point(), point(), 40);
    check_close(cross(d.right, d.up), -d.forward);
    CHECK(length(d.right) == doctest::Approx(1).epsilon(1e-5));
    CHECK(std::abs(dot(d.right, d.up)) < 1e-5f);
  }
  // Looking along `up`, any frame is valid.
  const Camera down = look_at({0, 0, 5}, {0, 0, 0}, {0, 0, 1}, 40);
  check_close(down.forward, {0, 0, -1});
  CHECK(length(cross(down.right, down.up) + down.forward) < 1e-5f);
  CHECK_THROWS_AS(look_at({1, 2, 3}, {1, 2, 3}, {0, 0, 1}, 40), UsageError);
}

TEST_CASE("a thin lens keeps the plane of focus sharp") {
  for (const CameraKind kind : {CameraKind::perspective, CameraKind::orthographic}) {
    Camera c = look_at({1, 2, 3}, {4, -1, 2}, {0, 0, 1}, 50);
    c.kind = kind;
    c.lens_radius = 0.1f;
    c.focal_distance = 2.5f;
    const ViewingCamera lens(c, 160, 120);
    c.lens_radius = 0;
    const ViewingCamera pinhole(c, 160, 120);
    Random r(2);
    float widest = 0;
    for (int i = 0; i < 200; ++i) {
      const Vec2 raster{160 * r.next_float(), 120 * r.next_float()};
      const Ray sharp = pinhole.ray(raster, middle_of_lens), ray = lens.ray(raster, r.next_vec2());
      const auto at_focus = [&](const Ray& q) {
        const float t = (c.focal_distance - dot(q.origin - c.position, c.forward)) /
                        dot(q.direction, c.forward);
        return q.origin + q.direction * t;
      };
      check_close(at_focus(ray), at_focus(sharp));
      const Vec3 off = ray.origin - sharp.origin;
      CHECK(std::abs(dot(off, c.forward)) < 1e-5f);
      CHECK(length(off) < 0.10001f);
      widest = std::max(widest, length(off));
      CHECK(length(ray.direction) == doctest::Approx(1).epsilon(1e-5));
    }
    CHECK(widest > 0.09f);
  }
}

TEST_CASE("image size: as requested, else the file's, else by aspect") {
  Camera c;
  c.width = 320;
  c.height = 200;
  CHECK(image_size(c, 64, 48).width == 64);
  CHECK(image_size(c, 0, 0).height == 200);
  // One side alone keeps the proportions.
  CHECK(image_size(c, 64, 0).height == 40);
  CHECK(image_size(c, 0, 50).width == 80);
  CHECK(image_size(c, 1, 0).height == 1);
  CHECK(image_size(c, 1 << 30, 0).height == 1 << 20);
  c.width = c.height = 0;
  CHECK(image_size(c, 0, 0).width == 1024);
  CHECK(image_size(c, 16, 0).height == 12);
  c.aspect = 2;
  CHECK(image_size(c, 0, 0).width == 2 * image_size(c, 0, 0).height);
  c.aspect = 1e30f;
  CHECK(image_size(c, 0, 0).width < 10000);
}

TEST_CASE("a scene without camera gets one inside its bounds; an empty scene gets one too") {
  Scene s;
  CHECK(is_finite(default_camera(s, {0, 1, 0}).position));
  s.materials.emplace_back();
  Mesh m;
  m.positions = {{0, 0, 0}, {4, 0, 0}, {4, 5, 3}};
  m.triangles = {{0, 1, 2}};
  s.meshes.push_back(m);
  const Camera c = default_camera(s, {0, 0, 1});
  for (size_t a = 0; a < 3; ++a) {
    CHECK(c.position[a] >= 0);
    CHECK(c.position[a] <= Vec3{4, 5, 3}[a]);
  }
  CHECK(c.up.z > 0.5f);
}

TEST_CASE("a fisheye spaces angles evenly in all directions") {
  Camera c;
  c.kind = CameraKind::fisheye;
  c.half_extent = pi_f / 2;
  constexpr float n = 200;
  for (const float share : {0.0f, 0.25f, 0.5f, 1.0f}) {
    // Along a row, a column and a diagonal.
    const float reach = share * n / 2, slanted = reach / std::sqrt(2.0f);
    for (const Vec2 at : {Vec2{n / 2 + reach, n / 2}, Vec2{n / 2, n / 2 - reach},
                          Vec2{n / 2 - slanted, n / 2 + slanted}})
      CHECK(angle_deg(c, int(n), int(n), at.x, at.y) ==
            doctest::Approx(90 * double(share)).epsilon(1e-3).scale(1));
  }
  const ViewingCamera v(c, int(n), int(n));
  check_close(v.ray({n, n / 2}, middle_of_lens).direction, {1, 0, 0});
  check_close(v.ray({n / 2, 0}, middle_of_lens).direction, {0, 1, 0});
  // The corners look behind the camera, at √2 times 90°.
  CHECK(angle_deg(c, int(n), int(n), 0, 0) == doctest::Approx(127.28).epsilon(1e-3));
  Vec2 raster;
  CHECK_FALSE(v.raster_of({0, 0, -1}, raster));
}
