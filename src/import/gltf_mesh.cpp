#include "import/gltf_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "import/mesh_clean.h"
#include "import/triangle_check.h"

namespace troffer {

namespace {

constexpr uint64_t mode_triangles = 4, mode_strip = 5, mode_fan = 6;
constexpr uint32_t type_unsigned_byte = 5121, type_unsigned_short = 5123, type_unsigned_int = 5125;

// Vertices that the primitive's corners run through: of the index list, or of the vertex list.
uint64_t corner_count(const GltfPrimitive& p) {
  return p.indices ? p.indices->count : p.positions.count;
}

AccessorView vector_accessor(const JsonNode& reference, const GltfBuffers& buffers,
                             uint32_t components, uint64_t vertex_count) {
  const AccessorView& view = buffers.accessor(reference.as_index(~uint32_t(0), "accessors"));
  if (view.components != components)
    reference.fail("its accessor should be of type VEC" + std::to_string(components));
  if (view.component_type == type_unsigned_int)
    reference.fail("its accessor may not be of 32-bit integers");
  if (view.count != vertex_count)
    reference.fail("its accessor has " + std::to_string(view.count) + " elements, but POSITION " +
                   std::to_string(vertex_count));
  return view;
}

AccessorView index_accessor(const JsonNode& reference, GltfBuffers& buffers,
                            uint64_t vertex_count) {
  const uint32_t number = reference.as_index(~uint32_t(0), "accessors");
  const AccessorView& view = buffers.accessor(number);
  const bool is_integer = view.component_type == type_unsigned_byte ||
                          view.component_type == type_unsigned_short ||
                          view.component_type == type_unsigned_int;
  if (view.components != 1 || !is_integer || view.is_normalized)
    reference.fail("its accessor should be of unsigned integer scalars");
  const uint32_t largest = buffers.largest_index(reference, number);
  if (view.count > 0 && largest >= vertex_count)
    reference.fail("its accessor has index " + std::to_string(largest) + ", but there are only " +
                   std::to_string(vertex_count) + " vertices");
  return view;
}

void read_texcoords(const JsonNode& attributes, const GltfBuffers& buffers, GltfPrimitive& p) {
  for (int set = 0; set < 16; ++set)
    if (const auto uv = attributes.find("TEXCOORD_" + std::to_string(set)))
      p.uvs.emplace(set, vector_accessor(*uv, buffers, 2, p.positions.count));
}

void name_what_is_ignored(const JsonNode& primitive, const JsonNode& attributes,
                          WarningLog& warnings) {
  if (attributes.find("COLOR_0")) warnings.add("vertex colours (COLOR_0) are ignored");
  if (attributes.find("JOINTS_0")) warnings.add("skinning is ignored: meshes stand as modelled");
  if (const auto targets = primitive.find("targets"))
    if (targets->size() > 0) warnings.add("morph targets are ignored");
  if (primitive.extension("KHR_draco_mesh_compression"))
    warnings.add("KHR_draco_mesh_compression is not supported; the uncompressed data is used");
}

// Positions in the list of corners of triangle i, front first [1] §3.7.2.1.
std::array<uint64_t, 3> corners_of(GltfTopology topology, uint64_t i) {
  switch (topology) {
    case GltfTopology::strip:
      return {i, i + 1 + i % 2, i + 2 - i % 2};
    case GltfTopology::fan:
      return {i + 1, i + 2, 0};
    default:
      return {3 * i, 3 * i + 1, 3 * i + 2};
  }
}

Vec3d vec3_of(const std::array<float, 4>& v) {
  return {double(v[0]), double(v[1]), double(v[2])};
}

// Renumbers the vertices that `triangles` use to 0, 1, … in their old order; returns the old
// numbers. Costs what is used, however many vertices the accessor has.
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

// Collects the triangles worth keeping, in terms of the accessors' vertices.
class TriangleReader {
 public:
  TriangleReader(const GltfPrimitive& p, const Affine& world) : p_(p), world_(world) {}

  Vec3d world_position(uint32_t vertex) const {
    return world_.point(vec3_of(p_.positions.read(vertex)));
  }

  std::vector<Triangle> read(WarningLog& warnings, PlacedBounds& bounds) const {
    std::vector<Triangle> triangles;
    const uint64_t n = p_.triangle_count();
    TriangleCheck check;
    const bool is_mirrored = world_.swaps_handedness();
    for (uint64_t i = 0; i < n; ++i) {
      Triangle t;
      const auto corners = corners_of(p_.topology, i);
      std::transform(corners.begin(), corners.end(), t.begin(),
                     [&](uint64_t c) { return vertex_at(c); });
      if (is_mirrored) std::swap(t[1], t[2]);
      const Vec3d a = world_position(t[0]), b = world_position(t[1]), c = world_position(t[2]);
      bounds.add_triangle(a, b, c);
      if (check.is_good(Vec3(a), Vec3(b), Vec3(c))) triangles.push_back(t);
    }
    check.report(warnings);
    return triangles;
  }

 private:
  // In range: read_gltf_primitive looked.
  uint32_t vertex_at(uint64_t corner) const {
    return p_.indices ? p_.indices->read_index(corner) : uint32_t(corner);
  }

  const GltfPrimitive& p_;
  const Affine& world_;
};

void read_normals(const GltfPrimitive& p, const Affine& world, const std::vector<uint32_t>& used,
                  Mesh& mesh) {
  // Affine::normal carries the sign of the determinant, but a normal does not change sides.
  const double side = world.swaps_handedness() ? -1 : 1;
  mesh.normals.reserve(used.size());
  for (const uint32_t v : used) {
    const Vec3d n = world.normal(vec3_of(p.normals->read(v))) * side;
    mesh.normals.push_back(Vec3(n * (1 / length(n))));  // NaN where it has no direction
  }
}

void read_uvs(const AccessorView& uvs, const std::vector<uint32_t>& used, Mesh& mesh) {
  mesh.uvs.reserve(used.size());
  for (const uint32_t v : used) {
    const auto value = uvs.read(v);
    mesh.uvs.push_back({value[0], value[1]});
  }
}

// Exporters that mirror sometimes leave the winding behind. Where every normal of a mesh lies on
// the back of its triangles, the normals are believed: the side that is shaded is the side that
// emits.
void wind_by_normals(Mesh& mesh, WarningLog& warnings) {
  if (mesh.normals.empty() || mesh.triangles.empty()) return;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 p = mesh.positions[t[0]];
    const Vec3 n = cross(mesh.positions[t[1]] - p, mesh.positions[t[2]] - p);
    for (const uint32_t v : t)
      if (!(dot(n, mesh.normals[v]) < 0)) return;
  }
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  warnings.add("a mesh is wound against its normals: the normals say which side is the front");
}

}  // namespace

uint64_t GltfPrimitive::triangle_count() const {
  const uint64_t n = corner_count(*this);
  if (topology == GltfTopology::triangles) return n / 3;
  return n < 3 ? 0 : n - 2;
}

std::optional<GltfPrimitive> read_gltf_primitive(const JsonNode& primitive, GltfBuffers& buffers,
                                                 WarningLog& warnings) {
  const uint64_t mode = primitive.integer_or("mode", mode_triangles, mode_fan);
  if (mode < mode_triangles) {
    warnings.add("points and lines are not shown");
    return std::nullopt;
  }
  const auto attributes = primitive.find("attributes");
  const auto position = attributes ? attributes->find("POSITION") : std::nullopt;
  if (!position) {
    warnings.add("mesh primitives without positions are not shown");
    return std::nullopt;
  }
  GltfPrimitive p;
  if (mode == mode_strip) p.topology = GltfTopology::strip;
  if (mode == mode_fan) p.topology = GltfTopology::fan;
  const uint32_t accessor = position->as_index(~uint32_t(0), "accessors");
  p.positions = vector_accessor(*position, buffers, 3, buffers.accessor(accessor).count);
  if (const auto normal = attributes->find("NORMAL"))
    p.normals = vector_accessor(*normal, buffers, 3, p.positions.count);
  read_texcoords(*attributes, buffers, p);
  if (const auto indices = primitive.find("indices"))
    p.indices = index_accessor(*indices, buffers, p.positions.count);
  if (const auto material = primitive.find("material"))
    p.material = material->as_index(~uint32_t(0), "materials");
  if (p.topology == GltfTopology::triangles && corner_count(p) % 3 != 0)
    warnings.add("the vertices of a mesh are not a multiple of 3; the last ones are left out");
  name_what_is_ignored(primitive, *attributes, warnings);
  return p;
}

Mesh make_gltf_mesh(const GltfPrimitive& p, const Affine& world, int uv_set, WarningLog& warnings,
                    PlacedBounds& bounds) {
  const TriangleReader reader(p, world);
  Mesh mesh;
  mesh.triangles = reader.read(warnings, bounds);
  const std::vector<uint32_t> used = compact(mesh.triangles, p.positions.count);
  mesh.positions.reserve(used.size());
  for (const uint32_t v : used) mesh.positions.emplace_back(reader.world_position(v));
  if (p.normals) read_normals(p, world, used, mesh);
  const auto uvs = p.uvs.find(uv_set);
  if (uvs != p.uvs.end()) read_uvs(uvs->second, used, mesh);
  clean_mesh(mesh, warnings);  // replaces normals and (u,v) that are not finite
  wind_by_normals(mesh, warnings);
  return mesh;
}

}  // namespace troffer
