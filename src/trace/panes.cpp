#include "trace/panes.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "trace/surface.h"

namespace troffer {

namespace {

constexpr size_t most_simple_triangles = 8;  // limit for a pane that is simple

// Panes that are not simple are joined to at most this many boxes. If light may meet one of them,
// rays decide.
constexpr size_t most_boxes = 64;

// Joins the boxes to `parts` boxes by halving them along the axis on which their centres are spread
// most.
void join_boxes(std::span<Box> boxes, size_t parts, std::vector<Box>& out) {
  if (boxes.empty()) return;
  if (parts <= 1 || boxes.size() == 1) {
    Box all;
    for (const Box& b : boxes) all.grow(b);
    out.push_back(all);
    return;
  }
  Box middles;
  for (const Box& b : boxes) middles.grow(b.centre());
  const Vec3 e = middles.extent();
  const size_t axis = e.x >= e.y && e.x >= e.z ? 0 : e.y >= e.z ? 1 : 2;
  std::stable_sort(boxes.begin(), boxes.end(), [axis](const Box& a, const Box& b) {
    return a.centre()[axis] < b.centre()[axis];
  });
  const size_t half = boxes.size() / 2;
  join_boxes(boxes.first(half), parts / 2, out);
  join_boxes(boxes.subspan(half), parts - parts / 2, out);
}

}  // namespace

PanePlaces::PanePlaces(const Scene& scene, const PaneGlass& glass) {
  std::vector<Box> not_simple, joined;
  for_each_mesh(scene, [&](uint32_t, const MeshInWorld& mesh) {
    if (!glass.is_pane(mesh.mesh().material) || mesh.size() == 0) return;
    Box box;
    const Material& m = scene.materials[mesh.mesh().material];
    const bool is_large = mesh.size() > most_simple_triangles;
    // leaves and instances may be very many
    if ((m.is_alpha_masked && (is_large || m.alpha.texture >= 0)) ||
        (is_large && mesh.instance() != nullptr)) {
      if (mesh.instance() != nullptr) {
        box = mesh.instance()->bounds;
      } else {
        for (const Vec3& p : mesh.mesh().positions) box.grow(p);
      }
      not_simple.push_back(box);
      return;
    }
    Vec3 normal;
    float largest = 0;
    std::vector<Vec3> points;
    for (size_t t = 0; t < mesh.size(); ++t) {
      const auto [a, b, c] = mesh.corners(t);
      for (const Vec3& p : {a, b, c}) {
        box.grow(p);
        points.push_back(p);
      }
      const Vec3 n = cross(b - a, c - a);
      if (const float l = length(n); l > largest) {
        largest = l;
        normal = n * (1 / l);
      }
    }
    make_simple(scene, mesh, glass, add(box, normal, points));
  });
  for (const Sphere& s : scene.spheres)
    if (glass.is_pane(s.material)) {
      Box box;
      box.grow(s.centre - Vec3{s.radius, s.radius, s.radius});
      box.grow(s.centre + Vec3{s.radius, s.radius, s.radius});
      add(box, {}, {});
    }
  for (const Disk& d : scene.disks)
    if (glass.is_pane(d.material)) {
      Box box;
      box.grow(d.centre - Vec3{d.radius, d.radius, d.radius});
      box.grow(d.centre + Vec3{d.radius, d.radius, d.radius});
      add(box, d.normal, {d.centre});
    }
  join_boxes(not_simple, most_boxes, joined);
  for (const Box& box : joined) add(box, {}, {});
}

PanePlaces::Place& PanePlaces::add(const Box& bounds, const Vec3& normal,
                                   const std::vector<Vec3>& points) {
  Place& p = places_.emplace_back();
  p.bounds = bounds;
  float magnitude = 0;
  for (size_t a = 0; a < 3; ++a)
    magnitude = std::max({magnitude, std::abs(bounds.lower[a]), std::abs(bounds.upper[a])});
  p.slack = ray_offset(magnitude);
  if (points.empty()) return p;
  p.normal = normal;
  p.height = dot(points[0], normal);
  for (const Vec3& x : points)
    if (std::abs(dot(x, normal) - p.height) > p.slack) p.normal = {};  // not flat
  return p;
}

// Marks a place as simple if its pane is flat, uniform, of few triangles and without varying
// normals.
void PanePlaces::make_simple(const Scene& scene, const MeshInWorld& in_world,
                             const PaneGlass& glass, Place& place) {
  constexpr int steps = 1024;
  const Mesh& mesh = in_world.mesh();
  const Material& material = scene.materials[mesh.material];
  if (!(length_squared(place.normal) > 0) || mesh.triangles.size() > most_simple_triangles) return;
  if (material.is_alpha_masked) {
    if (material.alpha.texture >= 0) return;
    for (size_t t = 0; t < in_world.size(); ++t) place.triangles.push_back(in_world.corners(t));
    place.by_cosine.assign(2, Rgb{1 - coverage(scene.textures, material, Vec2{})});
    return;
  }
  if (!glass.is_even(mesh.material) || material.normal_texture >= 0) return;
  for (uint32_t v = 0; v < mesh.normals.size(); ++v) {
    const Vec3 n = in_world.normal(v);
    if (std::abs(dot(n, place.normal)) < 0.9999f * length(n)) return;
  }
  for (size_t t = 0; t < in_world.size(); ++t) place.triangles.push_back(in_world.corners(t));
  for (int i = 0; i <= steps; ++i)
    place.by_cosine.push_back(glass.transmittance_at(mesh.material, float(i) / float(steps)));
}

namespace {

// Returns the extent of a box along a direction.
void extent_along(const Box& box, const Vec3& n, float& least, float& most) {
  least = most = 0;
  for (size_t a = 0; a < 3; ++a) {
    const float p = n[a] * box.lower[a], q = n[a] * box.upper[a];
    least += std::min(p, q);
    most += std::max(p, q);
  }
}

}  // namespace

void PanePlaces::between(const Box& a, const Box& b, PanesBetween& out) const {
  out = {};
  Box both = a;
  both.grow(b.lower);
  both.grow(b.upper);
  for (uint32_t i = 0; i < places_.size(); ++i) {
    const Place& p = places_[i];
    bool is_apart = false;
    for (size_t axis = 0; axis < 3; ++axis)
      is_apart |= p.bounds.lower[axis] - p.slack > both.upper[axis] ||
                  both.lower[axis] > p.bounds.upper[axis] + p.slack;
    if (is_apart) continue;
    if (length_squared(p.normal) > 0) {
      float least = 0, most = 0;
      extent_along(both, p.normal, least, most);
      if (least > p.height + p.slack || most < p.height - p.slack) continue;
    }
    out.are_any = true;
    out.are_simple = out.are_simple && !p.by_cosine.empty();
    out.places.push_back(i);
  }
}

namespace {

// True if a ray from x in direction w passes through the triangle: the three volumes that it spans
// with the edges have one sign.
bool goes_through(const std::array<Vec3, 3>& t, const Vec3& x, const Vec3& w) {
  const Vec3 a = t[0] - x, b = t[1] - x, c = t[2] - x;
  const float p = dot(cross(a, b), w), q = dot(cross(b, c), w), r = dot(cross(c, a), w);
  return (p >= 0 && q >= 0 && r >= 0) || (p <= 0 && q <= 0 && r <= 0);
}

}  // namespace

Rgb PanePlaces::transmittance(const PanesBetween& panes, const Vec3& x, const Vec3& way) const {
  Rgb left{1};
  const float distance = length(way);
  const Vec3 w = way * (1 / std::max(distance, 1e-30f));
  for (const uint32_t i : panes.places) {
    const Place& p = places_[i];
    const float cosine = dot(w, p.normal), height = p.height - dot(x, p.normal);
    // skips panes that x lies on, that lie behind x, or beyond the end
    if (std::abs(height) <= p.slack || !(height * cosine > 0) ||
        !(std::abs(height) < std::abs(cosine) * distance))
      continue;
    bool is_met = false;
    for (const auto& t : p.triangles) is_met = is_met || goes_through(t, x, w);
    if (!is_met) continue;
    const auto steps = float(p.by_cosine.size() - 1);
    const float at = std::min(std::abs(cosine), 1.0f) * steps;
    const auto k = std::min(size_t(at), p.by_cosine.size() - 2);
    left *= p.by_cosine[k] * (1 - (at - float(k))) + p.by_cosine[k + 1] * (at - float(k));
  }
  return left;
}

}  // namespace troffer
