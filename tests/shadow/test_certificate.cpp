#include <doctest/doctest.h>

#include <algorithm>

#include "brute_force.h"

using namespace troffer;
using namespace troffer::test;

namespace {

Vec3d point_on(const FlatSource& s, Random& r) {
  double u = r.next_double(), v = r.next_double();
  if (!s.outline.empty() && u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  return s.plane.origin + s.plane.u * u + s.plane.v * v;
}

}  // namespace

TEST_CASE("lit and dark certificates are never contradicted by a ray") {
  size_t lit = 0, dark = 0, contradictions = 0;
  for (uint64_t seed = 0; seed < 6000; ++seed) {
    Random r(seed);
    BruteForceScene scene;
    const FlatSource source = random_source(r);
    add_random_facets(r, scene);
    const std::vector<ShadowReceiver> receivers = random_receivers(r, 16);
    const CertifiedOptions options;
    FoundFacets found;
    std::vector<SourceVisibility> out(receivers.size());
    evaluate_alone(options, source, receivers, scene, found, out);
    for (size_t i = 0; i < receivers.size(); ++i) {
      const bool is_lit = out[i].answer == ShadowAnswer::lit;
      if (!is_lit && out[i].answer != ShadowAnswer::dark) continue;
      ++(is_lit ? lit : dark);
      for (int k = 0; k < 24; ++k) {
        const Vec3d y = point_on(source, r) + source.plane.normal * 1.6e-5;
        const Vec3d x(receivers[i].origin);
        if (dot(y - x, Vec3d(receivers[i].normal)) <= 0) continue;
        const int hidden = scene.is_hidden(x, y, 1e-7);
        if (hidden >= 0 && (hidden == 1) == is_lit) ++contradictions;
      }
    }
  }
  MESSAGE(lit, " lit and ", dark, " dark certificates");
  CHECK(contradictions == 0);
  CHECK(lit > 3000);
  CHECK(dark > 3000);
}

TEST_CASE("a shaft contains every segment between its ends") {
  size_t tested = 0, planes = 0;
  for (uint64_t seed = 0; seed < 4000; ++seed) {
    Random r(seed + 1000000);
    const FlatSource source = random_source(r);
    const std::vector<ShadowReceiver> receivers = random_receivers(r, 12);
    std::vector<Vec3> origins, normals;
    for (const ShadowReceiver& x : receivers) {
      origins.push_back(x.origin);
      normals.push_back(x.normal);
    }
    const ReceiverHull hull = bound_receivers(origins, normals);
    const Shaft shaft = make_shaft(hull, source.corners(), source.plane.normal, 10);
    planes += size_t(shaft.count);
    for (int k = 0; k < 20; ++k) {
      const ShadowReceiver& x = receivers[size_t(r.next_float() * 12)];
      const Vec3d from(x.origin), to = point_on(source, r);
      if (dot(to - from, Vec3d(x.normal)) <= 0 || dot(source.plane.normal, from - to) <= 0)
        continue;
      const double t = 0.999 * r.next_double();
      const Vec3d p = from + (to - from) * t;
      if (dot(source.plane.normal, p - to) < 1e-5) continue;
      ++tested;
      for (const Plane& plane : shaft.all())
        CHECK(dot(Vec3d(plane.normal), p) <= double(plane.distance));
    }
  }
  CHECK(tested > 20000);
  CHECK(planes > 4000 * 6);
}

TEST_CASE("a shaft excludes facets beside, behind and below") {
  const FlatSource source{{{-1, -1, 2}, {2, 0, 0}, {0, 2, 0}, {0, 0, -1}}, {}};
  const std::vector<Vec3> origins{{0, 0, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}, {0.1f, 0.1f, 0}};
  const std::vector<Vec3> normals(4, Vec3{0, 0, 1});
  const ReceiverHull hull = bound_receivers(origins, normals);
  CHECK(hull.is_flat);
  CHECK(hull.count == 4);
  const Shaft shaft = make_shaft(hull, source.corners(), source.plane.normal, 3);
  const auto is_inside = [&](const Vec3& p) {
    return std::all_of(shaft.all().begin(), shaft.all().end(),
                       [&](const Plane& plane) { return dot(plane.normal, p) <= plane.distance; });
  };
  CHECK(is_inside({0, 0, 1}));
  CHECK(is_inside({0.45f, 0.45f, 1}));
  CHECK_FALSE(is_inside({0.6f, 0, 1}));    // beside
  CHECK_FALSE(is_inside({0, 0, 2}));       // in the source's plane
  CHECK_FALSE(is_inside({0, 0, 2.1f}));    // behind
  CHECK_FALSE(is_inside({0, 0, -1e-5f}));  // below
  CHECK(is_inside({0, 0, 1.999f}));
  CHECK(is_inside({0, 0, 1e-4f}));
}

TEST_CASE("classification: clear cases are decided, doubtful ones are not") {
  const Parallelogram source{{-1, -1, 2}, {2, 0, 0}, {0, 2, 0}, {0, 0, -1}};
  const MaskFrame frame(source, coarse_lattice, false, {0, 0, 0});
  std::vector<MaskPoint> receivers;
  for (const Vec3d& c : {Vec3d{0, 0, 0}, {0.1, 0, 0}, {0.1, 0.1, 0}, {0, 0.1, 0}})
    receivers.push_back(mask_point(frame, frame.to_canvas(c), {0, 0}));
  const auto flag = [&](const Quad& q) {
    FacetList list;
    list.add(frame, q);
    list.finish();
    FacetFlags plain, wide;
    classify(list, receivers, 0, plain, 0);
    classify(list, receivers, 0, wide);
    CHECK(plain.quads == wide.quads);
    CHECK(plain.triangles == wide.triangles);
    return is_triangle(q) ? plain.triangles.at(0) : plain.quads.at(0);
  };
  const auto plate = [](float lower, float upper, float z) {
    return Quad{Vec3{lower, lower, z}, {upper, lower, z}, {upper, upper, z}, {lower, upper, z}};
  };
  CHECK(flag(plate(-2, 2, 1)) == 2);        // hides all
  CHECK(flag(plate(-0.5f, 0.6f, 1)) == 0);  // exactly the needed size: not proved
  CHECK(flag(plate(-0.6f, 0.7f, 1)) == 2);  // a little larger
  CHECK(flag(plate(-0.4f, 0.5f, 1)) == 0);  // hides a part
  CHECK(flag(plate(0.7f, 2, 1)) == 1);      // beside
  CHECK(flag({Vec3{-9, -9, 1}, {9, -9, 1}, {0, 20, 1}, {0, 20, 1}}) == 2);
  CHECK(flag({Vec3{0.7f, -9, 0}, {0.7f, 9, 0}, {2, 9, 2}, {2, -9, 2}}) == 1);
  CHECK(flag({Vec3{-9, -9, -1}, {9, -9, -1}, {9, 9, -1}, {-9, 9, -1}}) == 1);  // behind receivers
}
