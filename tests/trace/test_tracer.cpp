#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "base/random.h"
#include "base/warp.h"
#include "trace/surface.h"
#include "trace/tracer.h"

using namespace troffer;

namespace {

// Returns the inside of a unit cube with a sphere and a disk.
Scene box_scene() {
  Scene s;
  s.materials.resize(1);
  Mesh m;
  m.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                 {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  m.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}, {0, 5, 1}, {0, 4, 5},
                 {3, 2, 6}, {3, 6, 7}, {0, 3, 7}, {0, 7, 4}, {1, 5, 6}, {1, 6, 2}};
  s.meshes.push_back(m);
  s.spheres.push_back({{0.5f, 0.5f, 0.5f}, 0.2f, false, 0, no_light});
  s.disks.push_back({{0.5f, 0.5f, 0.9f}, {0, 0, -1}, 0.1f, 0, no_light});
  return s;
}

std::vector<Ray> random_rays(size_t n) {
  Random rng(7);
  std::vector<Ray> rays(n);
  for (Ray& r : rays) {
    r.origin = {rng.next_float() * 0.98f + 0.01f, rng.next_float() * 0.98f + 0.01f,
                rng.next_float() * 0.25f + 0.01f};
    r.direction = sphere_from_square(rng.next_vec2());
  }
  return rays;
}

}  // namespace

TEST_CASE("rays inside a closed box always hit, and packets agree with single rays") {
  const Scene scene = box_scene();
  const Tracer tracer(scene);
  const std::vector<Ray> rays = random_rays(5003);  // not a multiple of the packet size
  std::vector<Hit> single(rays.size()), packet(rays.size());
  tracer.closest(rays, single);
  tracer.closest(rays, packet, Coherence::coherent);
  size_t spheres = 0, disks = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    REQUIRE(single[i].is_valid());
    CHECK(packet[i].geometry == single[i].geometry);
    CHECK(packet[i].t == doctest::Approx(single[i].t).epsilon(1e-4));
    spheres += single[i].geometry == 1;
    disks += single[i].geometry == 2;
  }
  CHECK(spheres > 100);
  CHECK(disks > 5);
}

TEST_CASE("hit points lie on their surfaces and normals are unit") {
  const Scene scene = box_scene();
  const Tracer tracer(scene);
  const std::vector<Ray> rays = random_rays(2000);
  std::vector<Hit> hits(rays.size());
  tracer.closest(rays, hits);
  for (size_t i = 0; i < rays.size(); ++i) {
    const Surface s = surface_at(scene, rays[i], hits[i]);
    const Vec3 on_ray = rays[i].origin + rays[i].direction * hits[i].t;
    CHECK(length(s.position - on_ray) < 2e-5f);
    CHECK(length(s.geometric_normal) == doctest::Approx(1).epsilon(1e-5));
    if (hits[i].geometry == 1) {
      CHECK(length(s.position - Vec3{0.5f}) == doctest::Approx(0.2).epsilon(1e-6));
      CHECK(dot(s.geometric_normal, rays[i].direction) < 1e-3f);
    }
    if (hits[i].geometry == 2) CHECK(s.position.z == 0.9f);
  }
}

TEST_CASE("a ray that leaves a surface does not hit it again") {
  const Scene scene = box_scene();
  const Tracer tracer(scene);
  const std::vector<Ray> rays = random_rays(20000);
  std::vector<Hit> hits(rays.size());
  tracer.closest(rays, hits);
  Random rng(3);
  std::vector<Ray> next(rays.size());
  std::vector<Surface> surfaces(rays.size());
  for (size_t i = 0; i < rays.size(); ++i) {
    surfaces[i] = surface_at(scene, rays[i], hits[i]);
    Vec3 n = surfaces[i].geometric_normal;
    if (dot(n, rays[i].direction) > 0) n = -n;
    const Vec3 w = Frame(n).to_world(cosine_hemisphere_from_square(rng.next_vec2()));
    next[i].origin = offset_origin(surfaces[i], w);
    next[i].direction = w;
  }
  std::vector<Hit> again(rays.size());
  tracer.closest(next, again);
  for (size_t i = 0; i < rays.size(); ++i) {
    REQUIRE(again[i].is_valid());  // nothing escapes the closed box
    const bool is_convex = hits[i].geometry != 0;
    const Surface s = surface_at(scene, next[i], again[i]);
    if (is_convex)
      CHECK(again[i].geometry != hits[i].geometry);
    else if (again[i].geometry == 0) {  // another face than the one it left
      const bool is_parallel =
          std::abs(dot(s.geometric_normal, surfaces[i].geometric_normal)) > 0.5f;
      const float apart = std::abs(dot(s.geometric_normal, s.position - surfaces[i].position));
      CHECK((!is_parallel || apart > 0.5f));
    }
  }
}

TEST_CASE("occlusion agrees with closest hits, in both modes and within the given interval") {
  const Scene scene = box_scene();
  const Tracer tracer(scene);
  std::vector<Ray> rays = random_rays(3001);
  Random rng(5);
  for (Ray& r : rays) r.t_max = rng.next_float();
  std::vector<Hit> hits(rays.size());
  std::vector<uint8_t> single(rays.size()), packet(rays.size());
  tracer.closest(rays, hits);
  tracer.occluded(rays, single);
  tracer.occluded(rays, packet, Coherence::coherent);
  size_t occluded = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    CHECK(single[i] == (hits[i].is_valid() ? 1 : 0));
    CHECK(packet[i] == single[i]);
    occluded += single[i];
  }
  CHECK(occluded > 500);
  CHECK(occluded < rays.size() - 500);
}

TEST_CASE("segments are rays that end at t = 1") {
  const Scene scene = box_scene();
  const Tracer tracer(scene);
  std::vector<Ray> rays = random_rays(1003);  // the last packet has places to spare
  Segments segments;
  for (size_t i = 0; i < rays.size(); ++i) {
    Ray& r = rays[i];
    r.t_max = 1;
    r.direction = r.direction * 0.4f;
    if (i % 100 == 99) r.direction.x = std::numeric_limits<float>::quiet_NaN();
    segments.make_room(1);
    for (size_t a = 0; a < 3; ++a) {
      segments.end(a)[0] = r.origin[a];
      segments.end(3 + a)[0] = r.direction[a];
    }
    segments.grow(1);
  }
  std::vector<uint8_t> single(rays.size()), packet(rays.size());
  tracer.occluded(rays, single);
  tracer.occluded(segments, packet);
  CHECK(single == packet);
  CHECK(std::count(single.begin(), single.end(), 1) > 200);
  CHECK(std::count(single.begin(), single.end(), 0) > 200);
}

TEST_CASE("alpha masks let rays through") {
  Scene s;
  Texture t;
  t.kind = TextureKind::image;
  t.width = 2;
  t.height = 1;
  t.channels = 4;
  t.is_filtered = false;
  t.texels8 = {255, 255, 255, 255, 255, 255, 255, 0};  // left half opaque, right half not
  s.textures.push_back(t);
  Material m;
  m.is_alpha_masked = true;
  m.alpha = {1, 0, 3};
  s.materials = {m, Material{}};
  Mesh quad;
  quad.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  quad.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  quad.triangles = {{0, 1, 2}, {0, 2, 3}};
  s.meshes.push_back(quad);
  for (Vec3& p : quad.positions) p.z = -1;
  quad.material = 1;
  s.meshes.push_back(quad);
  const Tracer tracer(s);
  const std::vector<Ray> rays = {{{0.25f, 0.5f, 1}, 0, {0, 0, -1}},
                                 {{0.75f, 0.5f, 1}, 0, {0, 0, -1}}};
  for (const Coherence c : {Coherence::none, Coherence::coherent}) {
    std::vector<Hit> hits(2);
    tracer.closest(rays, hits, c);
    CHECK(hits[0].geometry == 0);
    CHECK(hits[1].geometry == 1);
    std::vector<Ray> shadow = rays;
    for (Ray& r : shadow) r.t_max = 1.5f;
    std::vector<uint8_t> occluded(2);
    tracer.occluded(shadow, occluded, c);
    CHECK(occluded[0] == 1);
    CHECK(occluded[1] == 0);
  }
}

TEST_CASE("normal maps tilt shading normals: red along u, green up the image") {
  Scene s;
  Texture t;
  t.kind = TextureKind::image;
  t.width = t.height = 1;
  t.channels = 3;
  t.is_srgb = false;
  t.texels_float = {1.0f, 0.5f, 1.0f};  // 45 degrees towards +u
  s.textures.push_back(t);
  t.texels_float = {0.5f, 1.0f, 1.0f};  // 45 degrees up the image, against v
  s.textures.push_back(t);
  Mesh quad;
  quad.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  quad.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};  // u along +x, v along -y: the image stands upright
  quad.triangles = {{0, 1, 2}, {0, 2, 3}};
  for (uint32_t i = 0; i < 2; ++i) {
    Material m;
    m.normal_texture = int32_t(i);
    s.materials.push_back(m);
    quad.material = i;
    s.meshes.push_back(quad);
  }
  Ray ray;
  ray.direction = {0, 0, -1};
  const float h = std::sqrt(0.5f);
  Hit hit;
  hit.u = hit.v = 0.3f;
  hit.geometry = 0;
  CHECK(length(surface_at(s, ray, hit).shading_normal - Vec3{h, 0, h}) < 1e-5f);
  hit.geometry = 1;
  CHECK(length(surface_at(s, ray, hit).shading_normal - Vec3{0, h, h}) < 1e-5f);
  // With mirrored texture coordinates the image and its relief are seen from behind.
  for (Vec2& uv : s.meshes[0].uvs) uv.x = 1 - uv.x;
  hit.geometry = 0;
  CHECK(length(surface_at(s, ray, hit).shading_normal - Vec3{-h, 0, h}) < 1e-5f);
  for (Vec2& uv : s.meshes[1].uvs) uv.x = 1 - uv.x;
  hit.geometry = 1;
  CHECK(length(surface_at(s, ray, hit).shading_normal - Vec3{0, h, h}) < 1e-5f);
}

TEST_CASE("an empty scene builds and nothing is hit") {
  const Scene scene;
  const Tracer tracer(scene);
  std::vector<Hit> hits(1);
  const std::vector<Ray> rays = {{{0, 0, 0}, 0, {0, 0, 1}}};
  tracer.closest(rays, hits);
  CHECK(!hits[0].is_valid());
}
