// Builds the facets of Occluders: connected components, closed surfaces, and merged triangles.
#include <algorithm>
#include <array>

#include "base/disjoint_sets.h"
#include "base/error.h"
#include "base/frame.h"
#include "base/merge_polygons.h"
#include "scene/mesh_in_world.h"
#include "trace/occluders.h"

namespace troffer {

namespace {

// True if a material hides something. A pane does so only where its alpha texture is 1.
bool hides_something(const Scene& scene, const PaneGlass* glass, uint32_t material) {
  const Material& m = scene.materials[material];
  return glass == nullptr || !glass->is_pane(material) ||
         (m.is_alpha_masked && m.alpha.texture >= 0);
}

}  // namespace

void Occluders::join_and_add(const Mesh& mesh, std::vector<uint32_t>& facet_of) {
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

  // components count as closed until an edge disproves it
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
  facet_of.assign(mesh.triangles.size(), no_facet);
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (merged.of_piece[t] == no_polygon) continue;
    facet_of[t] = first_facet + merged.of_piece[t];
    Box& bounds = components_[component_[facet_of[t]]].bounds;
    for (const uint32_t v : triangles[t]) bounds.grow(mesh.positions[v]);
  }
}

void Occluders::add_flat(const Quad& q, const RoundBody& round, uint64_t k) {
  Box b;
  for (const Vec3& v : q) b.grow(v);
  others_.push_back({b, q, true, round, k});
}

void Occluders::add_masked(const Mesh& mesh) {
  for (const Triangle& t : mesh.triangles)
    add_flat(
        {mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]], mesh.positions[t[2]]},
        {}, no_key);
}

void Occluders::add_round(const Scene& scene, const PaneGlass* glass) {
  const auto is_pane = [&](uint32_t material) {
    return glass != nullptr && glass->is_pane(material);
  };
  const auto meshes = uint32_t(scene.meshes.size());
  for (uint32_t i = 0; i < scene.spheres.size(); ++i) {
    const Sphere& s = scene.spheres[i];
    if (is_pane(s.material)) continue;
    // room for the rounding of Embree's intersections
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

// Reserves the largest possible size. Unused pages are never touched, while growing would copy.
void Occluders::reserve(std::span<const Mesh> meshes) {
  constexpr size_t large = 1 << 18;
  size_t triangles = 0, vertices = 0;
  for (const Mesh& mesh : meshes) {
    triangles += mesh.triangles.size();
    vertices += mesh.positions.size();
  }
  is_large_ = triangles > large;
  component_.reserve(triangles);
  if (!is_large_) return quads_.reserve(triangles);
  corners_.reserve(triangles);
  vertices_.reserve(vertices);
}

void Occluders::add_instances(const Scene& scene, const PaneGlass* glass) {
  std::vector<Vec3d> reaches;
  for (const Mesh& mesh : scene.instanced_meshes) {
    reaches.emplace_back(reach_of(mesh));
    const bool is_masked = scene.materials[mesh.material].is_alpha_masked;
    instanced_.spaces.emplace_back(
        hides_something(scene, glass, mesh.material) ? new Occluders(mesh, is_masked) : nullptr);
  }
  uint64_t facets = facet_count();
  for (const Instance& i : scene.instances) {
    Stand& stand = instanced_.stands.emplace_back();
    stand.first_facet = uint32_t(facets);
    if (instanced_.spaces[i.mesh] == nullptr) continue;
    stand.space = i.mesh;
    stand.world_from_space = i.world_from_mesh;
    stand.is_mirrored = i.is_mirrored;
    stand.bounds = i.bounds;
    stand.reach = abs(i.world_from_mesh.translation);
    for (size_t a = 0; a < 3; ++a)
      stand.reach += abs(i.world_from_mesh.columns[a]) * reaches[i.mesh][a];
    facets += instanced_.spaces[i.mesh]->facet_count();
    if (facets >= no_facet - 1)
      throw EnvironmentError("cannot tell apart the facets of so many instances");
  }
}

Occluders::Occluders(const Mesh& mesh, bool is_alpha_masked) : facet_of_(1) {
  reserve({&mesh, 1});
  if (is_alpha_masked)
    add_masked(mesh);
  else
    join_and_add(mesh, facet_of_[0]);
  build_tree();
}

Occluders::Occluders(const Scene& scene, const PaneGlass* glass) : facet_of_(scene.meshes.size()) {
  reserve(scene.meshes);
  const auto is_masked = [&](const Mesh& mesh) {
    return scene.materials[mesh.material].is_alpha_masked;
  };
  for (uint32_t i = 0; i < scene.meshes.size(); ++i)
    if (const Mesh& mesh = scene.meshes[i];
        !mesh.triangles.empty() && !is_masked(mesh) && hides_something(scene, glass, mesh.material))
      join_and_add(mesh, facet_of_[i]);
  for (const Mesh& mesh : scene.meshes)
    if (!mesh.triangles.empty() && is_masked(mesh) && hides_something(scene, glass, mesh.material))
      add_masked(mesh);
  add_round(scene, glass);
  add_instances(scene, glass);
  build_tree();
}

}  // namespace troffer
