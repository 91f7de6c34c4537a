// Compares rays and shafts through instances with those through copies of the meshes.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/random.h"
#include "base/warp.h"
#include "scene/mesh_in_world.h"
#include "support/instanced_scenes.h"
#include "trace/occluders.h"
#include "trace/surface.h"
#include "trace/tracer.h"

using namespace troffer;
using namespace troffer::test;

namespace test_instances {

namespace {

std::vector<Ray> rays_in_room(size_t n) {
  Random r(7);
  std::vector<Ray> rays(n);
  for (Ray& ray : rays) {
    const float x = r.next_float(), y = r.next_float();
    ray.origin = Vec3{-1.9f, -1.9f, 0.1f} + Vec3{x, y, r.next_float()} * 2.2f;
    ray.direction = sphere_from_square(r.next_vec2());
  }
  return rays;
}

// Returns the number that a hit geometry has in the scene of copies.
uint32_t number_of_copy(const Scene& scene, uint32_t geometry) {
  return is_instance(scene, geometry) ? geometry - 2 : geometry;
}

// Returns how many rays hit another surface in the two scenes, or see it differently. Sets
// `on_instances` to the number of rays that hit an instance.
size_t differences(const Scene& scene, const Scene& copies, const PaneGlass* glass,
                   Coherence coherence, Meeting meeting, size_t& on_instances) {
  const Tracer a(scene, glass), b(copies, glass);
  const std::vector<Ray> rays = rays_in_room(20'000);
  std::vector<Hit> hits(rays.size()), expected(rays.size());
  a.closest(rays, hits, coherence, meeting);
  b.closest(rays, expected, coherence, meeting);
  size_t n = 0;
  on_instances = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    const Hit &h = hits[i], &e = expected[i];
    if (h.is_valid() != e.is_valid() || number_of_copy(scene, h.geometry) != e.geometry ||
        h.primitive != e.primitive) {
      ++n;
      continue;
    }
    if (!h.is_valid()) continue;
    on_instances += is_instance(scene, h.geometry);
    const Surface s = surface_at(scene, rays[i], h), t = surface_at(copies, rays[i], e);
    CHECK(s.geometric_normal == t.geometric_normal);
    CHECK(s.material == t.material);
    CHECK(s.light == t.light);
    CHECK(s.geometry == h.geometry);
    CHECK(s.offset >= t.offset);
    CHECK(s.offset < 1e-4f);
    // Triangles are small, so an error of position makes a larger one in barycentric weights.
    n += length(s.position - t.position) > 1e-5f ||
         length(s.shading_normal - t.shading_normal) > 1e-3f ||
         std::abs(s.uv.uv.x - t.uv.uv.x) + std::abs(s.uv.uv.y - t.uv.uv.y) > 1e-3f;
  }
  return n;
}

class GlassOf : public PaneGlass {
 public:
  explicit GlassOf(uint32_t material) : material_(material) {}
  bool is_pane(uint32_t material) const override { return material == material_; }
  bool is_even(uint32_t) const override { return true; }
  Rgb transmittance_at(uint32_t, float) const override { return Rgb{0.5f}; }
  Rgb transmittance(const Ray&, const Hit&) const override { return Rgb{0.5f}; }

 private:
  uint32_t material_;
};

// Adds a chequered pattern of holes.
void punch(Scene& s) {
  Texture t;
  t.kind = TextureKind::image;
  t.width = t.height = 2;
  t.channels = 4;
  t.is_filtered = false;
  for (const uint8_t alpha : {0, 255, 255, 0}) t.texels8.insert(t.texels8.end(), {9, 9, 9, alpha});
  s.textures.push_back(t);
  Material& m = s.materials[s.instanced_meshes[0].material];
  m.is_alpha_masked = true;
  m.alpha.texture = int32_t(s.textures.size()) - 1;
  m.alpha.channel = 3;
}

using Corners = std::vector<std::array<float, 3>>;
Corners sorted_corners(const Quad& q) {
  Corners out;
  for (const Vec3& v : q) out.push_back({v.x, v.y, v.z});
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<Plane> some_shaft(Random& r) {
  const float x = r.next_float(), y = r.next_float();
  const Vec3 middle{3 * x - 1.5f, 3 * y - 1.5f, 1.5f * r.next_float()};
  std::vector<Plane> planes;
  for (int i = 0; i < 5; ++i) {
    const Vec3 n = sphere_from_square(r.next_vec2());
    planes.push_back({n, dot(n, middle) + 0.6f * r.next_float()});
  }
  return planes;
}

}  // namespace

TEST_CASE("rays meet instances as they meet copies") {
  const Scene scene = room_of_instances(places_in_room());
  const Scene copies = copied_out(scene);
  for (const Coherence c : {Coherence::none, Coherence::coherent}) {
    size_t on_instances = 0;
    CHECK(differences(scene, copies, nullptr, c, Meeting::all, on_instances) < 10);
    CHECK(on_instances > 1000);
  }
  std::vector<Ray> rays = rays_in_room(20'000);
  for (Ray& ray : rays) ray.t_max = 1;
  const Tracer a(scene), b(copies);
  for (const Coherence c : {Coherence::none, Coherence::coherent}) {
    std::vector<uint8_t> hidden(rays.size()), expected(rays.size());
    a.occluded(rays, hidden, c);
    b.occluded(rays, expected, c);
    size_t n = 0;
    for (size_t i = 0; i < rays.size(); ++i) n += hidden[i] != expected[i];
    CHECK(n < 5);
  }
}

TEST_CASE("holes and backs of instances, also mirrored ones, equal those of copies") {
  Scene scene = room_of_instances(places_in_room());
  size_t on_instances = 0;
  punch(scene);
  // Rays at the edge of a hole may differ.
  CHECK(differences(scene, copied_out(scene), nullptr, Coherence::none, Meeting::all,
                    on_instances) < 40);
  CHECK(on_instances > 500);
  Scene backs = room_of_instances(places_in_room());
  backs.materials[backs.instanced_meshes[0].material].back_faces = BackFaces::unseen;
  for (const Meeting meeting : {Meeting::all, Meeting::as_seen}) {
    backs.instanced_meshes[0] = dented_ball(backs.instanced_meshes[0].material, 12, false);
    CHECK(differences(backs, copied_out(backs), nullptr, Coherence::none, meeting, on_instances) <
          10);
    CHECK(on_instances > 500);
  }
}

TEST_CASE("instances of glass are panes") {
  const Scene scene = room_of_instances(places_in_room());
  const Scene copies = copied_out(scene);
  const GlassOf glass(scene.instanced_meshes[0].material);
  const Tracer a(scene, &glass), b(copies, &glass);
  REQUIRE(a.has_panes());
  size_t differ = 0, dimmed = 0;
  for (Ray ray : rays_in_room(4000)) {
    ray.t_max = 1.5f;
    const Rgb s = a.transmittance(ray), t = b.transmittance(ray);
    differ += !(s == t);
    dimmed += s.r < 1;
  }
  CHECK(differ < 5);
  CHECK(dimmed > 150);
  size_t on_instances = 0;
  CHECK(differences(scene, copies, &glass, Coherence::none, Meeting::no_panes, on_instances) < 10);
  CHECK(on_instances == 0);
  const PanePlaces here(scene, glass), there(copies, glass);
  Box all = bounds(scene);
  PanesBetween p, q;
  here.between(all, all, p);
  there.between(all, all, q);
  CHECK(p.places.size() == scene.instances.size());
  CHECK(p.places.size() == q.places.size());
}

TEST_CASE("shafts find the same facets with instances and with copies") {
  const Scene scene = room_of_instances(places_in_room());
  const Scene copies = copied_out(scene);
  const Occluders a(scene), b(copies);
  CHECK(a.facet_count() == 7);
  Random r(3);
  size_t of_instances = 0, left_out = 0;
  for (int k = 0; k < 300; ++k) {
    const std::vector<Plane> planes = some_shaft(r);
    Occluders::Found found, expected;
    a.gather(planes, 100'000, found);
    b.gather(planes, 100'000, expected);
    CHECK(found.is_complete);
    std::vector<Corners> here, there;
    for (const uint32_t f : found.facets) {
      here.push_back(sorted_corners(a.facet(f)));
      of_instances += f >= a.facet_count();
      CHECK(a.may_meet(f, planes));
    }
    for (const uint32_t f : expected.facets) there.push_back(sorted_corners(b.facet(f)));
    std::sort(here.begin(), here.end());
    std::sort(there.begin(), there.end());
    CHECK(here == there);
    Occluders::Found few;
    a.gather(planes, 3, few);
    CHECK(few.is_complete == (found.facets.size() <= 3));
    left_out += !few.is_complete;
  }
  CHECK(of_instances > 5000);
  CHECK(left_out > 50);
}

TEST_CASE("facets of instances have the orientation and closed surface of copies") {
  const Scene scene = room_of_instances(places_in_room());
  const Scene copies = copied_out(scene);
  const Occluders a(scene), b(copies);
  for (uint32_t k = 0; k < scene.instances.size(); ++k) {
    const uint32_t geometry = first_instance(scene) + k;
    const MeshInWorld mesh = mesh_at(scene, geometry);
    for (uint32_t t = 0; t < mesh.size(); ++t) {
      const uint32_t f = a.facet_of(geometry, t), g = b.facet_of(geometry - 2, t);
      REQUIRE(f != no_facet);
      const Quad p = a.facet(f), q = b.facet(g);
      CHECK(sorted_corners(p) == sorted_corners(q));
      CHECK(p[2] == p[3]);
      CHECK(dot(cross(p[1] - p[0], p[2] - p[0]), cross(q[1] - q[0], q[2] - q[0])) > 0);
      const Occluders::Component c = a.component_of(f), d = b.component_of(g);
      CHECK(c.is_closed);
      CHECK(d.is_closed);
      // The box around a transformed box is not smaller than its content.
      for (size_t axis = 0; axis < 3; ++axis) {
        CHECK(c.bounds.lower[axis] <= d.bounds.lower[axis]);
        CHECK(c.bounds.upper[axis] >= d.bounds.upper[axis]);
      }
    }
  }
  CHECK(a.facet_of(first_instance(scene) + uint32_t(scene.instances.size()), 0) == no_facet);
  CHECK(a.facet_of(first_instance(scene), 1'000'000) == no_facet);
}

TEST_CASE("instances with holes are distinguished, as copies are") {
  Scene scene = room_of_instances(places_in_room());
  punch(scene);
  const Scene copies = copied_out(scene);
  const Occluders a(scene), b(copies);
  Random r(4);
  size_t most = 0;
  for (int k = 0; k < 100; ++k) {
    const std::vector<Plane> planes = some_shaft(r);
    Occluders::Found found, expected;
    a.gather(planes, 100, found);
    b.gather(planes, 100, expected);
    most = std::max<size_t>(most, expected.others);
    if (expected.others > Occluders::most_masked) {
      CHECK(found.others > Occluders::most_masked);
      continue;
    }
    CHECK(found.others == expected.others);
    CHECK(found.masked.size() == expected.masked.size());
  }
  CHECK(most > 50);
}

TEST_CASE("two instances of a sheet that a ray meets alike draw their coverage independently") {
  // The second instance is turned half about the rays' axis, so all rays are the same in both.
  Scene s;
  Material m;
  m.is_alpha_masked = m.is_alpha_blended = true;
  m.alpha.value = 0.3f;
  s.materials.push_back(m);
  Mesh sheet;
  sheet.positions = {{-1, -2, 0}, {3, -2, 0}, {3, 1, 0}, {-1, 1, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  s.instanced_meshes.push_back(sheet);
  Affine turned;
  turned.columns[0] = {-1, 0, 0};
  turned.columns[1] = {0, -1, 0};
  for (const Affine& t : {Affine(), turned})
    s.instances.push_back(
        make_instance(0, t, "", reach_of(sheet), bounds_in_world(s.instanced_meshes[0], t)));
  const Tracer tracer(s, nullptr);
  constexpr size_t n = 10'000;
  std::vector<Ray> rays(n);
  for (size_t i = 0; i < n; ++i) {
    rays[i].origin = {0, 0, 1 + 1e-4f * float(i)};
    rays[i].direction = {0, 0, -1};
  }
  std::vector<Hit> hits(n);
  tracer.closest(rays, hits, Coherence::none, Meeting::all);
  const auto passed =
      double(std::count_if(hits.begin(), hits.end(), [](const Hit& h) { return !h.is_valid(); }));
  // One number for both would let .7 pass.
  const double expected = 0.7 * 0.7, sigma = std::sqrt(expected * (1 - expected) / n);
  CHECK(std::abs(passed / n - expected) < 4 * sigma);
}

}  // namespace test_instances
