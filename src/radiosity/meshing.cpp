#include "radiosity/meshing.h"

#include <algorithm>
#include <bit>
#include <map>
#include <unordered_map>

#include "base/random.h"
#include "radiosity/meshing_parts.h"
#include "scene/mesh_in_world.h"

namespace troffer {

namespace {

// Triangles with the same three corner positions, of any mesh and either orientation, are one
// surface, unless one of them emits.
std::vector<uint32_t> find_duplicates(const BaseGeometry& g) {
  using CornerPositions = std::array<std::array<float, 3>, 3>;
  struct Hash {
    size_t operator()(const CornerPositions& corners) const {
      uint64_t h = 0;
      for (const auto& c : corners)
        for (const float x : c) h = hash_combine(h, std::bit_cast<uint32_t>(x + 0.0f));  // no -0
      return size_t(h);
    }
  };
  std::unordered_map<CornerPositions, uint32_t, Hash> first;
  std::vector<uint32_t> same_as(g.triangles.size());
  for (uint32_t i = 0; i < g.triangles.size(); ++i) {
    const BaseTriangle& t = g.triangles[i];
    same_as[i] = i;
    if (t.is_degenerate || t.light != no_light) continue;
    if (g.surfaces[t.surface].bulge != Bulge::none) continue;
    CornerPositions corners;
    for (size_t k = 0; k < 3; ++k) {
      const Vec3& p = g.positions[t.vertices[k]];
      corners[k] = {p.x, p.y, p.z};
    }
    std::sort(corners.begin(), corners.end());
    same_as[i] = first.try_emplace(corners, i).first->second;
  }
  return same_as;
}

// Converts weights of triangle `from`'s corners to weights of `to`'s corners, which lie at the same
// positions. Returns true if their orientations are opposite: the front of one is the back of the
// other.
bool move_weights(const BaseGeometry& g, uint32_t from, uint32_t to, Vec3& weights) {
  const Vec3 own = weights;
  std::array<size_t, 3> place{};
  for (size_t k = 0; k < 3; ++k)
    for (size_t j = 0; j < 3; ++j)
      if (g.positions[g.triangles[to].vertices[k]] == g.positions[g.triangles[from].vertices[j]]) {
        weights[k] = own[j];
        place[k] = j;
      }
  return place[1] != (place[0] + 1) % 3;
}

void index_vertices(RadiosityMesh& mesh) {
  mesh.vertex_first.assign(mesh.geometry.positions.size() + 1, 0);
  for (const Fragment& f : mesh.fragments)
    for (const uint32_t v : f.vertices) ++mesh.vertex_first[v + 1];
  for (size_t i = 1; i < mesh.vertex_first.size(); ++i)
    mesh.vertex_first[i] += mesh.vertex_first[i - 1];
  mesh.vertex_fragments.resize(3 * mesh.fragments.size());
  std::vector<uint32_t> next(mesh.vertex_first.begin(), mesh.vertex_first.end() - 1);
  for (uint32_t i = 0; i < mesh.fragments.size(); ++i)
    for (const uint32_t v : mesh.fragments[i].vertices) mesh.vertex_fragments[next[v]++] = i;
}

template <class T>
size_t bytes_of(const std::vector<T>& v) {
  return v.capacity() * sizeof(T);
}

}  // namespace

size_t RadiosityMesh::memory_bytes() const {
  return bytes_of(points) + bytes_of(patches) + bytes_of(sheets) + bytes_of(pieces) +
         bytes_of(piece_corners) + bytes_of(element_points) + bytes_of(geometry.surfaces) +
         bytes_of(geometry.triangles) + bytes_of(geometry.positions) + bytes_of(geometry.flat) +
         bytes_of(same_as) + bytes_of(roots) + bytes_of(nodes) + bytes_of(fragments) +
         bytes_of(vertex_first) + bytes_of(vertex_fragments);
}

RadiosityMesh mesh_for_radiosity(const Scene& scene, const Tracer& tracer, const BsdfTables& tables,
                                 const MeshingOptions& options, int threads) {
  RadiosityMesh mesh;
  mesh.geometry = base_geometry(scene);
  mesh.same_as = find_duplicates(mesh.geometry);
  const JoinPlan plan = plan_joining(mesh.geometry, mesh.same_as, options);
  mesh.left_out = mesh.geometry.left_out;
  mesh.coarsened = plan.coarsened;
  mesh.element_size = plan.element_size;
  mesh.patch_size = plan.patch_size;
  mesh.join_angle_deg = plan.join_angle_deg;
  const Cut cut = cut_surfaces(scene, plan, mesh);
  index_vertices(mesh);
  make_points(scene, tracer, tables, options, threads, cut, mesh);
  return mesh;
}

Vec3 fragment_normal(const RadiosityMesh& mesh, uint32_t fragment) {
  const Fragment& f = mesh.fragments[fragment];
  const Vec3d a(mesh.geometry.positions[f.vertices[0]]);
  const Vec3d n = cross(Vec3d(mesh.geometry.positions[f.vertices[1]]) - a,
                        Vec3d(mesh.geometry.positions[f.vertices[2]]) - a);
  const double l = length(n);
  return l > 0 ? Vec3(n / l) : Vec3{0, 0, 1};
}

uint32_t fragment_at(const Scene& scene, const RadiosityMesh& mesh, uint32_t geometry,
                     uint32_t primitive, float u, float v, const Vec3& position, bool& is_back,
                     Vec3& weights) {
  const auto meshes = uint32_t(scene.meshes.size());
  uint32_t triangle = 0;
  const auto round = uint32_t(scene.spheres.size() + scene.disks.size());
  if (is_mesh(scene, geometry)) {
    const uint32_t surface = geometry < meshes ? geometry : geometry - 2 + round;
    triangle = mesh.geometry.surfaces[surface].first_triangle + primitive;
    weights = {1 - u - v, u, v};
    const uint32_t same = mesh.same_as[triangle];
    if (same != triangle) {
      if (move_weights(mesh.geometry, triangle, same, weights)) is_back = !is_back;
      triangle = same;
    }
  } else {
    const size_t surface = meshes + primitive + (geometry == meshes ? 0 : scene.spheres.size());
    triangle = flat_triangle(scene, mesh.geometry.surfaces[surface], position, weights);
  }
  int32_t at = mesh.roots[triangle];
  if (at == RadiosityMesh::no_root) return no_fragment;
  while (at >= 0) {
    const SplitNode& node = mesh.nodes[size_t(at)];
    const size_t a = node.edge, b = (a + 1) % 3;
    const float wa = weights[a], wb = weights[b];
    const bool is_first = wa >= wb;  // the half with corner a
    weights[a] = is_first ? wa - wb : 2 * wa;
    weights[b] = is_first ? 2 * wb : wb - wa;
    at = node.child[is_first ? 0 : 1];
  }
  return uint32_t(~at);
}

}  // namespace troffer
