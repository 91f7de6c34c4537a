#include "import/gltf/gltf_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "import/mesh_clean.h"
#include "import/triangle_check.h"

namespace troffer {

namespace {

constexpr size_t read_at_once = size_t(1) << 16;  // triangles or vertices per parallel task

Vec3d vec3_of(const std::array<float, 4>& v) {
  return {double(v[0]), double(v[1]), double(v[2])};
}

// Renumbers the vertices that `triangles` use to 0, 1, …, in their old order. Returns the old
// numbers. Time and memory are proportional to the triangles, however many vertices the accessor
// has.
std::vector<uint32_t> compact(std::vector<Triangle>& triangles, uint64_t vertex_count) {
  std::vector<uint32_t> used;
  if (vertex_count <= triangles.size() * 16) {
    std::vector<uint32_t> new_number(vertex_count, 0);
    for (const Triangle& t : triangles)
      for (const uint32_t v : t) new_number[v] = 1;
    for (uint32_t v = 0; v < vertex_count; ++v) {
      if (new_number[v] == 0) continue;
      new_number[v] = uint32_t(used.size());
      used.push_back(v);
    }
    for (Triangle& t : triangles)
      for (uint32_t& v : t) v = new_number[v];
    return used;
  }
  for (const Triangle& t : triangles) used.insert(used.end(), t.begin(), t.end());
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  for (Triangle& t : triangles)
    for (uint32_t& v : t)
      v = uint32_t(std::lower_bound(used.begin(), used.end(), v) - used.begin());
  return used;
}

// World positions and normals of a primitive's vertices: morph targets first, then the skin or the
// node's transform [1] §3.7.2.2, §3.7.3.
class Poser {
 public:
  Poser(const GltfPrimitive& p, const GltfPose& pose) : p_(p), pose_(pose) {
    is_skinned_ = !pose.joints.empty() && !p.joints.empty();
    is_mirrored_ = (is_skinned_ ? pose.joints.front() : pose.world_from_mesh).swaps_handedness();
  }

  bool is_mirrored() const { return is_mirrored_; }

  Vec3d position(uint32_t vertex) const {
    Vec3d at = vec3_of(p_.positions.read(vertex));
    for_each_target([&](const GltfMorphTarget& target, double weight) {
      if (target.positions) at += vec3_of(target.positions->read(vertex)) * weight;
    });
    return is_skinned_ ? joined(vertex).point(at) : pose_.world_from_mesh.point(at);
  }

  // Returns a unit normal; NaN if it has no direction.
  Vec3 normal(uint32_t vertex) const {
    Vec3d n = vec3_of(p_.normals->read(vertex));
    for_each_target([&](const GltfMorphTarget& target, double weight) {
      if (target.normals) n += vec3_of(target.normals->read(vertex)) * weight;
    });
    const Affine world = is_skinned_ ? joined(vertex) : pose_.world_from_mesh;
    // Affine::normal carries the sign of the determinant, but a normal must not change sides.
    n = world.normal(n) * (world.swaps_handedness() ? -1.0 : 1.0);
    return Vec3(n * (1 / length(n)));
  }

 private:
  template <class Visit>
  void for_each_target(const Visit& visit) const {
    const size_t n = std::min(p_.targets.size(), pose_.target_weights.size());
    for (size_t i = 0; i < n; ++i)
      if (pose_.target_weights[i] != 0) visit(p_.targets[i], pose_.target_weights[i]);
  }

  // Returns the vertex's joint transforms, averaged by their normalised weights.
  Affine joined(uint32_t vertex) const {
    Affine sum = Affine::scale({0, 0, 0});
    double total = 0;
    for (const GltfJoints& set : p_.joints) {
      const auto joints = set.joints.read(vertex), weights = set.weights.read(vertex);
      for (size_t k = 0; k < 4; ++k) {
        const auto w = double(weights[k]);
        if (!(w > 0) || !(joints[k] >= 0 && joints[k] < float(pose_.joints.size()))) continue;
        const Affine& joint = pose_.joints[size_t(joints[k])];
        for (size_t c = 0; c < 3; ++c) sum.columns[c] += joint.columns[c] * w;
        sum.translation += joint.translation * w;
        total += w;
      }
    }
    if (!(total > 0)) return pose_.world_from_mesh;
    for (Vec3d& column : sum.columns) column *= 1 / total;
    sum.translation *= 1 / total;
    return sum;
  }

  const GltfPrimitive& p_;
  const GltfPose& pose_;
  bool is_skinned_ = false, is_mirrored_ = false;
};

// Returns the triangles that pass TriangleCheck, as indices of the accessors' vertices.
std::vector<Triangle> read_triangles(const GltfPrimitive& p, const Poser& poser,
                                     WarningLog& warnings, PlacedBounds& bounds) {
  struct Piece {
    std::vector<Triangle> triangles;
    TriangleCheck check;
    PlacedBounds bounds;
  };
  const uint64_t n = p.triangle_count();
  std::vector<Piece> pieces(n / read_at_once + 1);
  parallel_pieces(n, read_at_once, [&](size_t first, size_t end) {
    Piece& piece = pieces[first / read_at_once];
    piece.triangles.reserve(end - first);
    for (size_t i = first; i < end; ++i) {
      Triangle t = p.triangle(i);
      if (poser.is_mirrored()) std::swap(t[1], t[2]);
      const Vec3d a = poser.position(t[0]), b = poser.position(t[1]), c = poser.position(t[2]);
      piece.bounds.add_triangle(a, b, c);
      if (piece.check.is_good(Vec3(a), Vec3(b), Vec3(c))) piece.triangles.push_back(t);
    }
  });
  std::vector<Triangle> triangles;
  TriangleCheck check;
  for (const Piece& piece : pieces) {
    check.add(piece.check);
    bounds.add(piece.bounds);
  }
  triangles.reserve(n - check.bad());
  for (const Piece& piece : pieces)
    triangles.insert(triangles.end(), piece.triangles.begin(), piece.triangles.end());
  check.report(warnings);
  return triangles;
}

// Returns of(vertex) for each vertex in `used`, computed in parallel.
template <class T, class Of>
std::vector<T> for_each_vertex(const std::vector<uint32_t>& used, const Of& of) {
  std::vector<T> out(used.size());
  parallel_pieces(used.size(), read_at_once, [&](size_t first, size_t end) {
    for (size_t i = first; i < end; ++i) out[i] = of(used[i]);
  });
  return out;
}

// Returns the texture coordinates of `set`. If the set is missing: zeros if `is_needed`, else
// empty.
std::vector<Vec2> read_uvs(const GltfPrimitive& p, int set, const std::vector<uint32_t>& used,
                           bool is_needed) {
  const auto found = p.uvs.find(set);
  if (found == p.uvs.end()) return std::vector<Vec2>(is_needed ? used.size() : 0);
  return for_each_vertex<Vec2>(used, [&](uint32_t v) {
    const auto value = found->second.read(v);
    return Vec2{value[0], value[1]};
  });
}

std::vector<TextureValue> read_colors(const AccessorView& colors,
                                      const std::vector<uint32_t>& used) {
  return for_each_vertex<TextureValue>(used, [&](uint32_t v) {
    const auto c = colors.read(v);
    return TextureValue{{c[0], c[1], c[2]}, colors.components == 4 ? c[3] : 1.0f};
  });
}

// Reverses the winding if every normal lies on the back of its triangles: some exporters mirror a
// mesh and keep the winding. The normals win, so that the shaded side is also the emitting side.
void wind_by_normals(Mesh& mesh, WarningLog& warnings) {
  if (mesh.normals.empty() || mesh.triangles.empty()) return;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 p = mesh.positions[t[0]];
    const Vec3 n = cross(mesh.positions[t[1]] - p, mesh.positions[t[2]] - p);
    for (const uint32_t v : t)
      if (!(dot(n, mesh.normals[v]) < 0)) return;
  }
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  warnings.add("a mesh is wound against its normals: the normals decide which side is the front");
}

}  // namespace

Mesh make_gltf_mesh(const GltfPrimitive& p, const GltfPose& pose, const GltfUvSets& sets,
                    WarningLog& warnings, PlacedBounds& bounds, std::vector<TextureValue>* colors) {
  const Poser poser(p, pose);
  Mesh mesh;
  mesh.triangles = read_triangles(p, poser, warnings, bounds);
  const std::vector<uint32_t> used = compact(mesh.triangles, p.positions.count);
  mesh.positions = for_each_vertex<Vec3>(used, [&](uint32_t v) { return Vec3(poser.position(v)); });
  if (p.normals)
    mesh.normals = for_each_vertex<Vec3>(used, [&](uint32_t v) { return poser.normal(v); });
  mesh.uvs_2 = read_uvs(p, sets.second, used, false);
  mesh.uvs = read_uvs(p, sets.first, used, !mesh.uvs_2.empty());
  if (colors && p.colors) *colors = read_colors(*p.colors, used);
  clean_mesh(mesh, warnings);  // replaces normals and (u,v) that are not finite
  wind_by_normals(mesh, warnings);
  return mesh;
}

}  // namespace troffer
