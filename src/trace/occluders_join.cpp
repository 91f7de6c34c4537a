// Scene -> facets: which triangles hang together, which surfaces are closed, which triangles are
// one quadrilateral.
#include <algorithm>
#include <array>

#include "base/disjoint_sets.h"
#include "base/frame.h"
#include "base/merge_polygons.h"
#include "trace/occluders.h"

namespace troffer {

void Occluders::join_and_add(const Scene& scene, uint32_t mesh_index) {
  const Mesh& mesh = scene.meshes[mesh_index];
  const std::vector<uint32_t> welded = weld(mesh.positions);
  PolygonList triangles;
  triangles.corners.reserve(3 * mesh.triangles.size());
  triangles.first.reserve(mesh.triangles.size() + 1);
  DisjointSets parts(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    const std::array<uint32_t, 3> corners{welded[t[0]], welded[t[1]], welded[t[2]]};
    parts.join(corners[0], corners[1]);
    parts.join(corners[0], corners[2]);
    triangles.add(corners);
  }

  // Components, closed unless an edge says otherwise.
  std::vector<uint32_t> component(mesh.positions.size(), no_facet);
  const auto component_at = [&](uint32_t vertex) -> uint32_t {
    uint32_t& c = component[parts.find(vertex)];
    if (c == no_facet) {
      c = uint32_t(components_.size());
      components_.push_back({Box{}, true});
    }
    return c;
  };
  const MergedPolygons merged =
      merge_polygons(mesh.positions, triangles, 4, [&](std::span<const PolygonEdge> edges) {
        const uint32_t c = component_at(edges[0].low);
        if (edges.size() != 2 || edges[0].is_forward == edges[1].is_forward)
          components_[c].is_closed = false;
      });
  const auto first_facet = uint32_t(facet_count());
  const auto first_vertex = uint32_t(vertices_.size());
  if (is_large_) vertices_.insert(vertices_.end(), mesh.positions.begin(), mesh.positions.end());
  for (size_t i = 0; i < merged.polygons.size(); ++i) {
    const std::span<const uint32_t> c = merged.polygons[i];
    const auto corner = [&](size_t k) { return c[std::min(k, c.size() - 1)]; };
    const auto vertex = [&](size_t k) { return mesh.positions[corner(k)]; };
    if (is_large_)
      corners_.push_back({first_vertex + corner(0), first_vertex + corner(1),
                          first_vertex + corner(2), first_vertex + corner(3)});
    else
      quads_.push_back({vertex(0), vertex(1), vertex(2), vertex(3)});
    component_.push_back(component_at(c[0]));
  }
  std::vector<uint32_t>& facet_of = facet_of_[mesh_index];
  facet_of.assign(mesh.triangles.size(), no_facet);
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (merged.of_piece[t] == no_polygon) continue;
    facet_of[t] = first_facet + merged.of_piece[t];
    Box& bounds = components_[component_[facet_of[t]]].bounds;
    for (const uint32_t v : triangles[t]) bounds.grow(mesh.positions[v]);
  }
}

void Occluders::add_others(const Scene& scene, const PaneGlass* glass) {
  const auto is_pane = [&](uint32_t material) {
    return glass != nullptr && glass->is_pane(material);
  };
  const auto add_flat = [&](const Quad& q, const RoundBody& round, uint64_t k) {
    Box b;
    for (const Vec3& v : q) b.grow(v);
    others_.push_back({b, q, true, round, k});
  };
  const auto meshes = uint32_t(scene.meshes.size());
  for (const Mesh& mesh : scene.meshes) {
    if (mesh.triangles.empty() || !scene.materials[mesh.material].is_alpha_masked) continue;
    for (const Triangle& t : mesh.triangles)
      add_flat(
          {mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]], mesh.positions[t[2]]},
          {}, no_key);
  }
  for (uint32_t i = 0; i < scene.spheres.size(); ++i) {
    const Sphere& s = scene.spheres[i];
    if (is_pane(s.material)) continue;
    // with room for the rounding of Embree's intersections
    const float slack = 1e-5f * (length(s.centre) + s.radius);
    const Vec3 reach = Vec3{1, 1, 1} * (s.radius + slack);
    Box b;
    b.grow(s.centre - reach);
    b.grow(s.centre + reach);
    others_.push_back({b, {}, false, {s.centre, s.radius, {}}, key(meshes, i)});
  }
  for (uint32_t i = 0; i < scene.disks.size(); ++i) {
    const Disk& d = scene.disks[i];
    if (is_pane(d.material)) continue;
    const Frame frame(d.normal);
    const Vec3 x = frame.tangent * (1.0001f * d.radius), y = frame.bitangent * (1.0001f * d.radius);
    add_flat({d.centre - x - y, d.centre + x - y, d.centre + x + y, d.centre - x + y},
             {d.centre, d.radius, d.normal}, key(meshes + 1, i));
  }
}

// Room for the most there can be: what is not needed of it is never touched, and growing would
// copy.
void Occluders::reserve(const Scene& scene) {
  constexpr size_t large = 1 << 18;
  const size_t triangles = triangle_count(scene);
  is_large_ = triangles > large;
  component_.reserve(triangles);
  if (!is_large_) return quads_.reserve(triangles);
  corners_.reserve(triangles);
  size_t vertices = 0;
  for (const Mesh& mesh : scene.meshes) vertices += mesh.positions.size();
  vertices_.reserve(vertices);
}

Occluders::Occluders(const Scene& scene, const PaneGlass* glass) : facet_of_(scene.meshes.size()) {
  reserve(scene);
  for (uint32_t i = 0; i < scene.meshes.size(); ++i)
    if (!scene.meshes[i].triangles.empty() &&
        !scene.materials[scene.meshes[i].material].is_alpha_masked &&
        !(glass != nullptr && glass->is_pane(scene.meshes[i].material)))
      join_and_add(scene, i);
  add_others(scene, glass);
  build_tree();
}

}  // namespace troffer
