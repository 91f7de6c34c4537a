#include "import/mitsuba/mitsuba_shape.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/units.h"
#include "import/file.h"
#include "import/mesh/obj.h"
#include "import/mesh/ply.h"
#include "import/mesh_clean.h"
#include "import/mitsuba/mitsuba_serialized.h"
#include "import/mitsuba/mitsuba_values.h"

namespace troffer {

namespace {

constexpr int cylinder_steps = 64, disk_steps = 128, disk_rings = 16;
constexpr double flat_tolerance = 1e-6;

// The square [-1,1]², front +z.
Mesh rectangle() {
  Mesh m;
  m.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  m.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  m.triangles = {{0, 1, 2}, {0, 2, 3}};
  return m;
}

// The cube [-1,1]³, front outside, with faces and (u,v) in Mitsuba's order. Bit k of a corner's
// number is the sign of axis k.
Mesh cube() {
  constexpr std::array<uint32_t, 24> corners{1, 5, 4, 0, 3, 2, 6, 7, 1, 3, 7, 5,
                                             5, 7, 6, 4, 4, 6, 2, 0, 3, 1, 0, 2};
  const std::array<Vec2, 4> uvs{Vec2{0, 1}, Vec2{1, 1}, Vec2{1, 0}, Vec2{0, 0}};
  const auto sign = [](uint32_t corner, uint32_t bit) { return corner & bit ? 1.0f : -1.0f; };
  Mesh m;
  for (uint32_t v = 0; v < corners.size(); ++v) {
    const uint32_t c = corners[v];
    m.positions.emplace_back(sign(c, 1), sign(c, 2), sign(c, 4));
    m.uvs.push_back(uvs[v % 4]);
    if (v % 4 != 0) continue;
    m.triangles.push_back({v, v + 1, v + 2});
    m.triangles.push_back({v + 3, v, v + 2});
  }
  return m;
}

// Axes perpendicular to a cylinder's axis. The azimuth counts from the first one [3].
struct Across {
  Vec3d x, y;
};
Across across(const Vec3d& n) {
  const double sign = std::copysign(1.0, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
  return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}};
}

// Mantle between two points, without caps, front outside; u runs around and v along.
Mesh cylinder(const Vec3d& p0, const Vec3d& p1, double radius) {
  const auto [x, y] = across(normalize(p1 - p0));
  Mesh m;
  for (int i = 0; i <= cylinder_steps; ++i) {
    const double phi = 2 * pi * (i % cylinder_steps) / cylinder_steps;
    const Vec3d n = x * std::cos(phi) + y * std::sin(phi);
    for (const Vec3d& end : {p0, p1}) {
      m.positions.emplace_back(end + n * radius);
      m.normals.emplace_back(n);
      m.uvs.push_back({float(i) / cylinder_steps, end == p0 ? 0.0f : 1.0f});
    }
    if (i == cylinder_steps) break;
    const auto a = uint32_t(2 * i);
    m.triangles.push_back({a, a + 2, a + 3});
    m.triangles.push_back({a, a + 3, a + 1});
  }
  return m;
}

double angle_between(const Vec3d& a, const Vec3d& b) {
  return std::atan2(length(cross(a, b)), dot(a, b));
}

// Adds vertex normals as Mitsuba does: the mean of the face normals, weighted by their angles. Adds
// none if all equal the face normals.
void add_smooth_normals(Mesh& mesh) {
  std::vector<Vec3d> sums(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    const Vec3d n = area_vector(mesh, t);
    const double size = length(n);
    if (!(size > 0) || !std::isfinite(size)) continue;
    for (size_t k = 0; k < 3; ++k) {
      const Vec3d p(mesh.positions[t[k]]);
      const Vec3d a = Vec3d(mesh.positions[t[(k + 1) % 3]]) - p;
      const Vec3d b = Vec3d(mesh.positions[t[(k + 2) % 3]]) - p;
      sums[t[k]] += n * (angle_between(a, b) / size);
    }
  }
  bool is_flat = true;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d n = area_vector(mesh, t);
    for (const uint32_t v : t)
      is_flat = is_flat && dot(n, sums[v]) >= (1 - flat_tolerance) * length(n) * length(sums[v]);
  }
  if (is_flat) return;
  mesh.normals.reserve(sums.size());
  for (const Vec3d& n : sums)
    // zero normals are repaired when placed
    mesh.normals.push_back(length(n) > 0 ? Vec3(normalize(n)) : Vec3{});
}

bool belongs_to(const std::string& material, const MitsubaObjPart& part) {
  if (!part.name.empty()) return material == part.name;
  return std::find(part.others.begin(), part.others.end(), material) == part.others.end();
}

}  // namespace

// Rings of quads between lines of equal azimuth; the innermost ring has triangles.
Mesh mitsuba_disk() {
  Mesh m;
  for (int j = 0; j <= disk_rings; ++j) {
    for (int i = 0; i <= disk_steps; ++i) {
      const double r = double(j) / disk_rings;
      const double phi = 2 * pi * (i % disk_steps) / disk_steps;
      m.positions.emplace_back(Vec3d{r * std::cos(phi), r * std::sin(phi), 0});
      const float turn = j == 0 ? (float(i) + 0.5f) / disk_steps : float(i) / disk_steps;
      m.uvs.push_back({float(r), turn});
    }
  }
  const auto at = [](int i, int j) { return uint32_t(j * (disk_steps + 1) + i); };
  for (int j = 0; j < disk_rings; ++j) {
    for (int i = 0; i < disk_steps; ++i) {
      if (j > 0) m.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
      m.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
    }
  }
  return m;
}

std::string MitsubaShapes::file_path(const MitsubaNode& node) {
  const std::string name = get_text(node, "filename", "");
  const ConfinedPath path = tree_.file(name);
  if (!path.is_fine()) node.place.fail("cannot use '" + shortened(name) + "': " + path.problem);
  return path.path;
}

// Returns the OBJ file, or its part of one material, as one mesh. The file's own materials are
// ignored: the scene file sets the look.
AnchoredMesh MitsubaShapes::read_obj(const std::string& path, const MitsubaObjPart* part) {
  if (last_obj_.path != path) last_obj_ = {path, import_obj(path)};
  const Scene& scene = last_obj_.scene;
  AnchoredMesh out;
  out.anchor = scene.origin;
  bool has_uvs = false, has_normals = false;
  for (const Mesh& m : scene.meshes) {
    has_uvs = has_uvs || !m.uvs.empty();
    has_normals = has_normals || !m.normals.empty();
  }
  Mesh& all = out.mesh;
  for (const Mesh& m : scene.meshes) {
    if (part && !belongs_to(snake_case(scene.materials[m.material].name), *part)) continue;
    const auto first = uint32_t(all.positions.size());
    all.positions.insert(all.positions.end(), m.positions.begin(), m.positions.end());
    all.uvs.insert(all.uvs.end(), m.uvs.begin(), m.uvs.end());
    all.normals.insert(all.normals.end(), m.normals.begin(), m.normals.end());
    if (has_uvs) all.uvs.resize(all.positions.size());
    if (has_normals) all.normals.resize(all.positions.size());
    for (const Triangle& t : m.triangles)
      all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return out;
}

AnchoredMesh MitsubaShapes::read_mesh_file(const MitsubaNode& node, const MitsubaObjPart* part) {
  const std::string path = file_path(node);
  AnchoredMesh out;
  bool has_face_normals = get_flag(node, "face_normals", false);
  if (node.type == "obj") {
    out = read_obj(path, part);
  } else if (node.type == "ply") {
    out = read_ply(path, warnings_);
  } else {
    if (last_file_.path != path) last_file_ = {path, read_file(path)};
    const int index = get_integer(node, "shape_index", 0);
    if (index < 0) node.place.fail("shape_index must not be negative");
    SerializedMesh mesh = read_serialized(last_file_.bytes, size_t(index), path);
    has_face_normals = has_face_normals || mesh.has_face_normals;
    out = std::move(mesh.mesh);
  }
  if (get_flag(node, "flip_tex_coords", node.type == "obj"))
    for (Vec2& uv : out.mesh.uvs) uv.y = 1 - uv.y;
  if (has_face_normals) out.mesh.normals.clear();
  if (out.mesh.normals.empty() && !has_face_normals) add_smooth_normals(out.mesh);
  if (find_parameter(node, "max_smooth_angle"))
    warnings_.add("shape \"" + shortened(node.type) + "\": 'max_smooth_angle' is not used");
  for (const char* name : {"collapse", "srgb", "shape_index"}) find_parameter(node, name);
  return out;
}

std::optional<MitsubaShape> MitsubaShapes::read(const MitsubaNode& node,
                                                const MitsubaObjPart* part) {
  MitsubaShape shape;
  shape.is_turned = get_flag(node, "flip_normals", false);
  const std::string& type = node.type;
  if (type == "obj" || type == "ply" || type == "serialized") {
    shape.mesh = read_mesh_file(node, part);
    if (shape.mesh.mesh.triangles.empty()) return std::nullopt;
  } else if (type == "rectangle" || type == "cube") {
    shape.mesh.mesh = type == "cube" ? cube() : rectangle();
    shape.keeps_side = true;
  } else if (type == "sphere") {
    shape.kind = MitsubaShapeKind::sphere;
    shape.radius = get_number(node, "radius", 1);
    shape.centre = get_vector(node, "center").value_or(Vec3d{0});
    if (!(shape.radius > 0)) node.place.fail("radius must be positive");
  } else if (type == "disk") {
    shape.kind = MitsubaShapeKind::disk;
  } else if (type == "cylinder") {
    const Vec3d p0 = get_vector(node, "p0").value_or(Vec3d{0, 0, 0});
    const Vec3d p1 = get_vector(node, "p1").value_or(Vec3d{0, 0, 1});
    const double radius = get_number(node, "radius", 1);
    if (!(radius > 0) || !(length(p1 - p0) > 0)) node.place.fail("cylinder without extent");
    shape.mesh.mesh = cylinder(p0, p1, radius);
  } else {
    for (const MitsubaNode* child : node.children) child->is_used = true;
    warnings_.add("shape \"" + shortened(type) + "\" is not supported: left out");
    return std::nullopt;
  }
  return shape;
}

}  // namespace troffer
