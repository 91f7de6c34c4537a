// Tests footprints of rays on textured surfaces, bump maps, and invisible back faces.
#include <doctest/doctest.h>

#include <cmath>

#include "base/units.h"
#include "support/textures.h"
#include "trace/surface.h"
#include "trace/tracer.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// Returns a square of 4 × 4 m in the plane z = 0 with (u,v) = (x, y) / 2 and its front up.
Scene square(const Material& material, const Texture& texture) {
  Scene s;
  s.textures.push_back(texture);
  s.materials.push_back(material);
  Mesh m;
  m.positions = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
  for (const Vec3& p : m.positions) m.uvs.push_back({p.x / 2, p.y / 2});
  m.triangles = {{0, 1, 2}, {0, 2, 3}};
  s.meshes.push_back(m);
  return s;
}

// Returns a ramp of heights .3 u + .1 v.
Texture ramp() {
  Texture t = grey_image(64, 64, [](int x, int y) {
    return 0.3f * (float(x) + 0.5f) / 32 + 0.1f * (float(y) + 0.5f) / 32;
  });
  t.wrap_u = t.wrap_v = WrapMode::clamp;
  t.uv_scale = {0.5f, 0.5f};
  return t;
}

Surface hit_from(const Scene& scene, const Vec3& origin, const Vec3& target, const RayCone& cone) {
  const Tracer tracer(scene);
  Ray ray;
  ray.origin = origin;
  ray.direction = normalize(target - origin);
  Hit hit;
  tracer.closest({&ray, 1}, {&hit, 1});
  REQUIRE(hit.is_valid());
  Surface s;
  surface_at(scene, ray, hit, s, cone);
  return s;
}

}  // namespace

TEST_CASE("a footprint is as wide as the cone, and longer on tilted surfaces") {
  Material m;
  m.base_color.texture = 0;
  const Scene scene = square(m, ramp());
  // from 5 m above: 5 cm wide, 0.025 in (u,v)
  Surface s = hit_from(scene, {2, 2, 5}, {2, 2, 0}, {0, 0.01f});
  CHECK(s.uv.width == doctest::Approx(0.05));
  CHECK(std::sqrt(dot(s.uv.axis_a, s.uv.axis_a)) == doctest::Approx(0.025));
  CHECK(std::sqrt(dot(s.uv.axis_b, s.uv.axis_b)) == doctest::Approx(0.025));
  // 60 degrees from the normal along x: twice as long there
  s = hit_from(scene, {2 - std::sqrt(3.0f), 2, 1}, {2, 2, 0}, {0.05f, 0});
  CHECK(std::abs(s.uv.axis_a.x) == doctest::Approx(0.05));
  CHECK(std::abs(s.uv.axis_a.y) < 1e-5f);
  CHECK(std::abs(s.uv.axis_b.y) == doctest::Approx(0.025));
  s = hit_from(scene, {2, 2, 5}, {2, 2, 0}, {});
  CHECK(s.uv.axis_a == Vec2{0, 0});
}

TEST_CASE("bumps tilt the normal by the gradient of their heights") {
  for (const float cone : {0.0f, 0.2f})
    for (const float scale : {1.0f, -2.0f}) {
      Material m;
      m.bump = {scale, 0, 0};
      const Scene scene = square(m, ramp());
      const Surface s = hit_from(scene, {1.9f, 2.1f, 5}, {1.9f, 2.1f, 0}, {cone, 0});
      // a unit of (u,v) is 2 m
      const Vec3 expected = normalize(Vec3{-0.15f * scale, -0.05f * scale, 1});
      CHECK(length(s.shading_normal - expected) < 2e-3f);
      CHECK(s.geometric_normal.z == doctest::Approx(1));
    }
}

TEST_CASE("mirrored coordinates and smooth normals do not move bumps") {
  Material m;
  m.bump = {1, 0, 0};
  Scene scene = square(m, ramp());
  for (Vec2& uv : scene.meshes[0].uvs) uv.x = 2 - uv.x;
  const Vec3 n = hit_from(scene, {2, 2, 5}, {2, 2, 0}, {}).shading_normal;
  CHECK(length(n - normalize(Vec3{0.15f, -0.05f, 1})) < 2e-3f);
}

TEST_CASE("invisible back sides are invisible only to the camera") {
  for (const bool is_masked : {false, true}) {
    Material m;
    m.back_faces = BackFaces::unseen;
    if (is_masked) {
      m.is_alpha_masked = true;
      m.alpha = {1, no_texture, 0};
    }
    const Scene scene = square(m, ramp());
    const Tracer tracer(scene);
    std::vector<Ray> rays(20);
    for (size_t i = 0; i < rays.size(); ++i) {
      rays[i].origin = {1 + float(i) * 0.1f, 1.3f, i % 2 == 0 ? 1.0f : -1.0f};
      rays[i].direction = {0.1f, 0.2f, i % 2 == 0 ? -1.0f : 1.0f};
    }
    std::vector<Hit> hits(rays.size());
    for (const Coherence coherence : {Coherence::none, Coherence::coherent}) {
      tracer.closest(rays, hits, coherence, Meeting::as_seen);
      for (size_t i = 0; i < rays.size(); ++i) CHECK(hits[i].is_valid() == (i % 2 == 0));
      tracer.closest(rays, hits, coherence);
      for (size_t i = 0; i < rays.size(); ++i) CHECK(hits[i].is_valid());
    }
    std::vector<uint8_t> hidden(rays.size());
    tracer.occluded(rays, hidden);
    for (const uint8_t h : hidden) CHECK(h == 1);
  }
}

TEST_CASE("with one-sided triangles back to back, every ray hits the one that faces it") {
  for (const bool is_turned_first : {false, true}) {
    Material m;
    m.back_faces = BackFaces::unseen;
    Scene scene = square(m, ramp());
    scene.meshes.push_back(scene.meshes[0]);
    for (Triangle& t : scene.meshes[is_turned_first ? 0 : 1].triangles) std::swap(t[1], t[2]);
    const uint32_t up = is_turned_first ? 1 : 0;
    const Tracer tracer(scene);
    std::vector<Ray> rays(20);
    for (size_t i = 0; i < rays.size(); ++i) {
      rays[i].origin = {1 + float(i) * 0.1f, 1.3f, i % 2 == 0 ? 1.0f : -1.0f};
      rays[i].direction = {0.1f, 0.2f, i % 2 == 0 ? -1.0f : 1.0f};
    }
    std::vector<Hit> hits(rays.size());
    for (const Coherence coherence : {Coherence::none, Coherence::coherent})
      for (const Meeting meeting : {Meeting::all, Meeting::as_seen}) {
        tracer.closest(rays, hits, coherence, meeting);
        for (size_t i = 0; i < rays.size(); ++i) {
          REQUIRE(hits[i].is_valid());
          CHECK(hits[i].geometry == (i % 2 == 0 ? up : 1 - up));
        }
      }
    std::vector<uint8_t> hidden(rays.size());
    tracer.occluded(rays, hidden);
    for (const uint8_t h : hidden) CHECK(h == 1);
  }
}

TEST_CASE("textured emission is averaged over the footprint") {
  // Columns of 1 and 3, each 1/64 of (u,v) wide, which is 1/32 m.
  Texture columns = grey_image(64, 1, [](int x, int) { return x % 2 == 0 ? 1.0f : 3.0f; });
  build_levels(columns);
  Scene scene = square(Material{}, columns);
  Light light;
  light.kind = LightKind::mesh;
  light.triangles = {0, 1};
  light.texture = 0;
  light.radiance = Rgb{2};
  scene.lights.push_back(light);
  scene.meshes[0].lights = {0, 0};
  double spread = 0;
  for (int i = 0; i < 20; ++i) {
    const Vec3 at{1 + 0.0173f * float(i), 2.1f, 0};
    const Surface far = hit_from(scene, at + Vec3{0, 0, 5}, at, {0.5f, 0});
    CHECK(emitted_radiance(scene, scene.lights[0], true, far.uv).g ==
          doctest::Approx(4).epsilon(0.02));
    const Surface near = hit_from(scene, at + Vec3{0, 0, 5}, at, {});
    const float point = emitted_radiance(scene, scene.lights[0], true, near.uv).g;
    CHECK(point == emitted_radiance(scene, scene.lights[0], true, near.uv.uv).g);
    spread = std::max(spread, std::abs(double(point) - 4));
  }
  CHECK(spread > 1);
}

TEST_CASE("anisotropy lies along increasing u, rotated as given, in the frame of the normal") {
  const Vec3 expected[] = {{1, 0, 0}, {0, -1, 0}, {0, 1, 0}};
  for (int i = 0; i < 3; ++i) {
    Material m;
    m.anisotropy.value = 0.5f;
    // counterclockwise with v downwards: from +u to -v, which is -y here
    if (i == 1) m.anisotropy_rotation_rad = float(pi / 2);
    Texture up;  // direction from a texture: red .5 and green 0 point down the image
    up.value = {0.5f, 0, 1};
    if (i == 2) m.anisotropy.texture = 0;
    const Scene scene = square(m, up);
    const Surface s = hit_from(scene, {1.9f, 2.1f, 5}, {1.9f, 2.1f, 0}, {});
    const Vec3 grain = Frame(s.shading_normal).to_world({s.uv.grain.x, s.uv.grain.y, 0});
    CHECK(std::abs(dot(grain, expected[i])) == doctest::Approx(1));
    if (i > 0) CHECK(dot(grain, expected[i]) == doctest::Approx(1));
  }
}

TEST_CASE("a second set of coordinates: its place, its footprint, and the axes of its normal map") {
  Material m;
  m.base_color = {Rgb{1}, 0};
  m.normal_texture = 1;
  Scene scene = square(m, ramp());
  for (const Vec3& p : scene.meshes[0].positions)
    scene.meshes[0].uvs_2.push_back({p.y / 4, p.x / 4});
  Texture lean;  // red .75: towards increasing u
  lean.value = {0.75f, 0.5f, 1};
  scene.textures.push_back(lean);
  for (const bool is_second : {false, true}) {
    for (Texture& t : scene.textures)
      t.mapping = is_second ? TextureMapping::second_uv : TextureMapping::uv;
    const Surface s = hit_from(scene, {1.4f, 2.2f, 5}, {1.4f, 2.2f, 0}, {0.1f, 0});
    CHECK(s.uv.uv_2.x == doctest::Approx(0.55));
    CHECK(s.uv.uv_2.y == doctest::Approx(0.35));
    CHECK(std::sqrt(dot(s.uv.axis_a, s.uv.axis_a)) == doctest::Approx(0.05));
    CHECK(std::sqrt(dot(s.uv.axis_2a, s.uv.axis_2a)) == doctest::Approx(0.025));
    const float value = evaluate(scene.textures, m.base_color, s.uv).g;
    const Vec2 uv = is_second ? s.uv.uv_2 : s.uv.uv;
    CHECK(value == doctest::Approx(0.3 * double(uv.x) + 0.1 * double(uv.y)).epsilon(0.02));
    const Vec3 expected = normalize(is_second ? Vec3{0, 0.5f, 1} : Vec3{0.5f, 0, 1});
    CHECK(length(s.shading_normal - expected) < 1e-3f);
  }
}
