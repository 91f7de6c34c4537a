// Scene -> facets: which triangles hang together, which surfaces are closed, which pairs of
// triangles are one quadrilateral.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/disjoint_sets.h"
#include "base/frame.h"
#include "trace/occluders.h"

namespace troffer {

namespace {

struct Edge {
  uint32_t low, high;  // welded vertices
  uint32_t triangle;
  uint8_t side;  // runs from vertex `side` of the triangle to the next
  bool is_forward;
  float length2;
};

// Vertices at the same place get the same number.
std::vector<uint32_t> weld(const std::vector<Vec3>& positions) {
  std::vector<uint32_t> order(positions.size()), welded(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto less = [&](uint32_t i, uint32_t j) {
    const Vec3 &a = positions[i], &b = positions[j];
    if (a.x != b.x) return a.x < b.x;
    if (a.y != b.y) return a.y < b.y;
    return a.z < b.z;
  };
  std::sort(order.begin(), order.end(), less);
  for (size_t i = 0; i < order.size(); ++i)
    welded[order[i]] = i > 0 && !less(order[i - 1], order[i]) ? welded[order[i - 1]] : order[i];
  return welded;
}

bool has_area(const Mesh& mesh, uint32_t t) {
  const Triangle& c = mesh.triangles[t];
  const Vec3d p(mesh.positions[c[0]]);
  const double twice =
      length(cross(Vec3d(mesh.positions[c[1]]) - p, Vec3d(mesh.positions[c[2]]) - p));
  return twice > 0 && std::isfinite(twice);
}

// The quadrilateral of two triangles that share an edge: flat within rounding and convex?
bool is_flat_and_convex(const Quad& q) {
  const Vec3d a(q[0]), b(q[1]), c(q[2]), d(q[3]);
  const Vec3d normal = normalize(cross(c - a, d - b));
  if (!is_finite(normal)) return false;
  double largest = 0;
  for (const Vec3& v : q)
    largest =
        std::max({largest, std::abs(double(v.x)), std::abs(double(v.y)), std::abs(double(v.z))});
  const double height =
      std::abs(dot(normal, b - a)) + std::abs(dot(normal, c - a)) + std::abs(dot(normal, d - a));
  if (height > 0x1p-22 * largest) return false;
  const Vec3d sides[4] = {b - a, c - b, d - c, a - d};
  for (size_t i = 0; i < 4; ++i) {
    const Vec3d &s = sides[i], &t = sides[(i + 1) % 4];
    if (!(dot(cross(s, t), normal) > 1e-9 * length(s) * length(t))) return false;
  }
  return true;
}

}  // namespace

void Occluders::join_and_add(const Scene& scene, uint32_t mesh_index) {
  const Mesh& mesh = scene.meshes[mesh_index];
  const auto triangles = uint32_t(mesh.triangles.size());
  std::vector<uint32_t>& facet_of = facet_of_[mesh_index];
  facet_of.assign(triangles, no_facet);
  const std::vector<uint32_t> welded = weld(mesh.positions);

  std::vector<Edge> edges;
  edges.reserve(3 * size_t(triangles));
  DisjointSets parts(mesh.positions.size());
  for (uint32_t t = 0; t < triangles; ++t) {
    for (uint8_t side = 0; side < 3; ++side) {
      const uint32_t from = welded[mesh.triangles[t][side]];
      const uint32_t to = welded[mesh.triangles[t][(side + 1) % 3]];
      parts.join(from, to);
      if (from == to) continue;
      const float length2 = length_squared(mesh.positions[to] - mesh.positions[from]);
      edges.push_back({std::min(from, to), std::max(from, to), t, side, from < to, length2});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    if (a.low != b.low) return a.low < b.low;
    if (a.high != b.high) return a.high < b.high;
    return a.triangle < b.triangle;
  });

  // Components, and pairs of triangles across edges that only they share.
  std::vector<uint32_t> component(mesh.positions.size(), no_facet);
  const auto component_at = [&](uint32_t vertex) -> uint32_t {
    uint32_t& c = component[parts.find(vertex)];
    if (c == no_facet) {
      c = uint32_t(components_.size());
      components_.push_back({Box{}, true});
    }
    return c;
  };
  std::vector<std::array<uint32_t, 2>> pairs;  // indices into edges
  for (uint32_t i = 0; i < edges.size();) {
    uint32_t end = i;
    while (end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high)
      ++end;
    const bool is_inner = end - i == 2 && edges[i].is_forward != edges[i + 1].is_forward;
    if (is_inner)
      pairs.push_back({i, i + 1});
    else
      components_[component_at(edges[i].low)].is_closed = false;
    i = end;
  }
  std::stable_sort(pairs.begin(), pairs.end(), [&](const auto& a, const auto& b) {
    return edges[a[0]].length2 > edges[b[0]].length2;
  });

  const auto vertex = [&](uint32_t t, uint32_t i) {
    return mesh.positions[mesh.triangles[t][i % 3]];
  };
  const auto add = [&](const Quad& q, uint32_t t) {
    const uint32_t c = component_at(welded[mesh.triangles[t][0]]);
    for (const Vec3& v : q) components_[c].bounds.grow(v);
    component_.push_back(c);
    facets_.push_back(q);
    return uint32_t(facets_.size() - 1);
  };
  for (const auto& [first, second] : pairs) {
    const Edge &e = edges[first], &f = edges[second];
    if (facet_of[e.triangle] != no_facet || facet_of[f.triangle] != no_facet) continue;
    if (e.triangle == f.triangle || !has_area(mesh, e.triangle) || !has_area(mesh, f.triangle))
      continue;
    const Quad q{vertex(e.triangle, e.side), vertex(f.triangle, f.side + 2u),
                 vertex(e.triangle, e.side + 1u), vertex(e.triangle, e.side + 2u)};
    if (!is_flat_and_convex(q)) continue;
    facet_of[e.triangle] = facet_of[f.triangle] = add(q, e.triangle);
  }
  for (uint32_t t = 0; t < triangles; ++t) {
    if (facet_of[t] != no_facet || !has_area(mesh, t)) continue;
    facet_of[t] = add({vertex(t, 0), vertex(t, 1), vertex(t, 2), vertex(t, 2)}, t);
  }
}

void Occluders::add_others(const Scene& scene) {
  const auto add_flat = [&](const Quad& q, uint64_t k) {
    Box b;
    for (const Vec3& v : q) b.grow(v);
    others_.push_back({b, q, true, k});
  };
  const auto meshes = uint32_t(scene.meshes.size());
  for (const Mesh& mesh : scene.meshes) {
    if (mesh.triangles.empty() || !scene.materials[mesh.material].is_alpha_masked) continue;
    for (const Triangle& t : mesh.triangles)
      add_flat(
          {mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]], mesh.positions[t[2]]},
          no_key);
  }
  for (uint32_t i = 0; i < scene.spheres.size(); ++i) {
    const Sphere& s = scene.spheres[i];
    // with room for the rounding of Embree's intersections
    const float slack = 1e-5f * (length(s.centre) + s.radius);
    const Vec3 reach = Vec3{1, 1, 1} * (s.radius + slack);
    Box b;
    b.grow(s.centre - reach);
    b.grow(s.centre + reach);
    others_.push_back({b, {}, false, key(meshes, i)});
  }
  for (uint32_t i = 0; i < scene.disks.size(); ++i) {
    const Disk& d = scene.disks[i];
    const Frame frame(d.normal);
    const Vec3 x = frame.tangent * (1.0001f * d.radius), y = frame.bitangent * (1.0001f * d.radius);
    add_flat({d.centre - x - y, d.centre + x - y, d.centre + x + y, d.centre - x + y},
             key(meshes + 1, i));
  }
}

Occluders::Occluders(const Scene& scene) : facet_of_(scene.meshes.size()) {
  for (uint32_t i = 0; i < scene.meshes.size(); ++i)
    if (!scene.meshes[i].triangles.empty() &&
        !scene.materials[scene.meshes[i].material].is_alpha_masked)
      join_and_add(scene, i);
  add_others(scene);
  build_tree();
}

}  // namespace troffer
