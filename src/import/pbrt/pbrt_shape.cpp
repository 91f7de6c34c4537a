#include "import/pbrt/pbrt_shape.h"

#include <cmath>

#include "import/file.h"
#include "import/limits.h"
#include "import/mesh/ply.h"
#include "import/pbrt/pbrt_curve.h"
#include "import/subdivide_loop.h"
#include "import/tessellate.h"

namespace troffer {

namespace {

constexpr int curved_patch_cells = 16;

template <class Vector>
std::vector<Vector> vectors_of(const std::vector<double>& numbers) {
  std::vector<Vector> out;
  out.reserve(numbers.size() / 3);
  for (size_t i = 0; i + 2 < numbers.size(); i += 3)
    out.emplace_back(Vec3d{numbers[i], numbers[i + 1], numbers[i + 2]});
  return out;
}

// Reads "point2 uv", or with a warning the "float uv" of pbrt-v3 files.
std::vector<Vec2> read_uvs(const PbrtParams& params, WarningLog& warnings) {
  const PbrtParam* param = params.find("uv");
  if (!param) return {};
  if (param->type == PbrtType::real && param->numbers.size() % 2 == 0)
    warnings.add(at_place(param->place, "\"float uv\" is pbrt-v3 syntax; pbrt-v4 says \"point2\""));
  else
    params.numbers("uv", PbrtType::point2);  // checks the type
  std::vector<Vec2> out;
  out.reserve(param->numbers.size() / 2);
  for (size_t i = 0; i + 1 < param->numbers.size(); i += 2)
    out.emplace_back(float(param->numbers[i]), float(param->numbers[i + 1]));
  return out;
}

// Drops per-vertex data whose length differs from the positions', as pbrt does.
template <class T>
void check_length(std::vector<T>& values, size_t vertices, const char* name,
                  const PbrtParams& params, WarningLog& warnings) {
  if (values.empty() || values.size() == vertices) return;
  warnings.add(params.owner + ": \"" + name + "\" does not have one value per vertex; ignored");
  values.clear();
}

struct VertexData {
  AnchoredMesh vertices;  // without triangles
  std::vector<uint32_t> indices;
};

// Reads P, N, uv and indices of a mesh whose faces have `corners` vertices.
VertexData read_vertices(const PbrtParams& params, size_t corners, WarningLog& warnings) {
  VertexData data;
  set_positions(data.vertices, vectors_of<Vec3d>(params.numbers("P", PbrtType::point3)));
  Mesh& mesh = data.vertices.mesh;
  const size_t n = mesh.positions.size();
  if (n == 0) fail_at(params.place, params.owner + " needs \"point3 P\"");
  mesh.normals = vectors_of<Vec3>(params.numbers("N", PbrtType::normal));
  mesh.uvs = read_uvs(params, warnings);
  check_length(mesh.normals, n, "N", params, warnings);
  check_length(mesh.uvs, n, "uv", params, warnings);
  params.ignore({"S", "faceIndices"});
  const PbrtParam* indices = params.find("indices");
  if (!indices) {
    if (n != corners) fail_at(params.place, params.owner + " needs \"integer indices\"");
    for (size_t i = 0; i < n; ++i) data.indices.push_back(uint32_t(i));
    return data;
  }
  params.numbers("indices", PbrtType::integer);  // checks the type
  if (indices->numbers.size() % corners != 0)
    fail_at(indices->place,
            "the number of indices is not a multiple of " + std::to_string(corners));
  data.indices.reserve(indices->numbers.size());
  for (const double i : indices->numbers) {
    if (i < 0 || i >= double(n))
      fail_at(indices->place, "vertex index " + std::to_string(int64_t(i)) + " out of range (" +
                                  std::to_string(n) + " vertices)");
    data.indices.push_back(uint32_t(i));
  }
  return data;
}

AnchoredMesh read_triangle_mesh(const PbrtParams& params, WarningLog& warnings) {
  VertexData data = read_vertices(params, 3, warnings);
  Mesh& mesh = data.vertices.mesh;
  mesh.triangles.reserve(data.indices.size() / 3);
  for (size_t i = 0; i < data.indices.size(); i += 3)
    mesh.triangles.push_back({data.indices[i], data.indices[i + 1], data.indices[i + 2]});
  return std::move(data.vertices);
}

// Limits of subdivision, which takes about 200 bytes per triangle. A small file must not expand to
// gigabytes; 64 = 4³ allows pbrt's default of three levels for control meshes of any size.
constexpr uint64_t always_subdivided = 2'000'000, most_subdivided_ratio = 64;

AnchoredMesh read_subdivision(const PbrtParams& params, WarningLog& warnings) {
  constexpr int most_levels = 12;
  VertexData data = read_vertices(params, 3, warnings);
  const int levels = params.get_int("levels", 3);
  params.ignore({"scheme"});
  if (levels < 0 || levels > most_levels)
    fail_at(params.place, params.owner + ": levels must be from 0 to " +
                              std::to_string(most_levels) + ", not " + std::to_string(levels));
  const uint64_t coarse = data.indices.size() / 3, fine = coarse << (2 * levels);
  const uint64_t most =
      std::min(max_scene_triangles, std::max(always_subdivided, coarse * most_subdivided_ratio));
  if (fine > most)
    fail_at(params.place, params.owner + ": " + std::to_string(levels) + " levels make " +
                              std::to_string(fine) + " triangles of " + std::to_string(coarse) +
                              "; at most " + std::to_string(most) + " are made");
  AnchoredMesh& control = data.vertices;
  for (size_t i = 0; i < data.indices.size(); i += 3)
    control.mesh.triangles.push_back({data.indices[i], data.indices[i + 1], data.indices[i + 2]});
  return {subdivide_loop(control.mesh, levels), control.anchor};
}

// Splits planar patches into two triangles each, which share the file's vertices. If any patch is
// curved, every patch is cut into cells, so that neighbours meet without gaps.
AnchoredMesh read_bilinear_mesh(const PbrtParams& params, WarningLog& warnings) {
  VertexData data = read_vertices(params, 4, warnings);
  params.ignore({"emissionfilename"});  // only guides pbrt's light sampling
  Mesh& vertices = data.vertices.mesh;
  std::vector<BilinearPatch> patches;
  bool is_flat = true;
  for (size_t i = 0; i < data.indices.size(); i += 4) {
    BilinearPatch patch;
    patch.is_smooth = !vertices.normals.empty();
    for (size_t k = 0; k < 4; ++k) {
      const uint32_t v = data.indices[i + k];
      patch.corners[k] = vertices.positions[v];
      if (!vertices.normals.empty()) patch.normals[k] = vertices.normals[v];
      if (!vertices.uvs.empty()) patch.uvs[k] = vertices.uvs[v];
    }
    is_flat = is_flat && is_planar(patch);
    patches.push_back(patch);
  }
  const bool shares_vertices = is_flat && (!vertices.uvs.empty() || patches.size() == 1);
  if (!shares_vertices) {
    const size_t cells = is_flat ? 1 : curved_patch_cells;
    if (patches.size() > max_scene_triangles / (2 * cells * cells))
      fail_at(params.place, "too many triangles");
    AnchoredMesh cut{{}, data.vertices.anchor};
    for (const BilinearPatch& patch : patches) append_patch(cut.mesh, patch, int(cells));
    return cut;
  }
  if (vertices.uvs.empty()) {
    vertices.uvs.resize(vertices.positions.size());
    for (size_t k = 0; k < 4; ++k) vertices.uvs[data.indices[k]] = BilinearPatch().uvs[k];
  }
  for (size_t i = 0; i < data.indices.size(); i += 4) {
    const uint32_t* q = &data.indices[i];  // 00, 10, 01, 11
    vertices.triangles.push_back({q[0], q[1], q[3]});
    vertices.triangles.push_back({q[0], q[3], q[2]});
  }
  return std::move(data.vertices);
}

AnchoredMesh read_ply_mesh(const PbrtParams& params, const std::string& folder,
                           WarningLog& warnings) {
  const PbrtParam* file = params.find("filename");
  if (!file) fail_at(params.place, params.owner + " needs a \"string filename\"");
  const std::string name = params.get_string("filename", "");
  if (params.has("displacement"))
    warnings.add(params.owner + ": displacement is not supported; ignored");
  params.ignore({"edgelength"});
  const ConfinedPath path = confined_path(folder, name);
  if (!path.is_fine()) fail_at(file->place, "cannot use '" + name + "': " + path.problem);
  return read_ply(path.path, warnings, {.max_triangles = max_scene_triangles});
}

bool read_sphere(const PbrtParams& params, PbrtShape& shape) {
  const double r = params.get_float("radius", 1);
  const double z0 = params.get_float("zmin", -r), z1 = params.get_float("zmax", r);
  const double phi_deg = params.get_float("phimax", 360);
  const double z_min = std::clamp(std::min(z0, z1), -std::abs(r), std::abs(r));
  const double z_max = std::clamp(std::max(z0, z1), -std::abs(r), std::abs(r));
  if (!(r > 0) || !(z_max > z_min) || !(phi_deg > 0)) return false;
  if (z_min <= -r && z_max >= r && phi_deg >= 360) {
    shape.kind = PbrtShapeKind::sphere;
    shape.radius = r;
  } else {
    shape.is_quadric = true;
    shape.mesh = std::make_shared<const AnchoredMesh>(AnchoredMesh{
        tessellate_sphere(r, z_min, z_max, rad_from_deg(std::min(phi_deg, 360.0))), {}});
  }
  return true;
}

bool read_cylinder(const PbrtParams& params, PbrtShape& shape) {
  const double r = params.get_float("radius", 1);
  const double z0 = params.get_float("zmin", -1), z1 = params.get_float("zmax", 1);
  const double phi_deg = params.get_float("phimax", 360);
  if (!(r > 0) || z0 == z1 || !(phi_deg > 0)) return false;
  shape.is_quadric = true;
  shape.mesh = std::make_shared<const AnchoredMesh>(
      AnchoredMesh{tessellate_cylinder(r, std::min(z0, z1), std::max(z0, z1),
                                       rad_from_deg(std::min(phi_deg, 360.0))),
                   {}});
  return true;
}

bool read_disk(const PbrtParams& params, PbrtShape& shape) {
  const double r = params.get_float("radius", 1), height = params.get_float("height", 0);
  const double inner = params.get_float("innerradius", 0);
  const double phi_deg = params.get_float("phimax", 360);
  if (!(r > 0) || !(inner < r) || !(phi_deg > 0)) return false;
  if (inner <= 0 && phi_deg >= 360) {
    shape.kind = PbrtShapeKind::disk;
    shape.radius = r;
    shape.height = height;
  } else {
    shape.is_quadric = true;
    shape.mesh = std::make_shared<const AnchoredMesh>(AnchoredMesh{
        tessellate_disk(height, r, std::max(inner, 0.0), rad_from_deg(std::min(phi_deg, 360.0))),
        {}});
  }
  return true;
}

// Returns false if alpha is 0 everywhere. An emitting shape of alpha 0 stays: in pbrt it still
// emits.
bool read_alpha(const PbrtParams& params, bool shines, PbrtTextures& textures, WarningLog& warnings,
                PbrtShape& shape) {
  if (!params.has("alpha")) return true;
  const FloatInput alpha = textures.real(params, "alpha", 1);
  if (shines && alpha.texture < 0 && alpha.value <= 0) {
    warnings.add("a light of constant alpha 0 is shown: it is seen, and hides what lies behind");
    return true;
  }
  if (alpha.texture >= 0 || alpha.value < 1) shape.alpha = alpha;
  if (alpha.texture >= 0 || alpha.value > 0) return true;
  warnings.add("shape with constant alpha 0 is left out");
  return false;
}

}  // namespace

bool read_pbrt_shape(const std::string& type, const PbrtParams& params, bool shines,
                     PbrtTextures& textures, WarningLog& warnings, PbrtShape& shape) {
  shape.type = type;
  bool has_area = true;
  if (type == "trianglemesh") {
    shape.mesh = std::make_shared<const AnchoredMesh>(read_triangle_mesh(params, warnings));
  } else if (type == "plymesh") {
    shape.mesh =
        std::make_shared<const AnchoredMesh>(read_ply_mesh(params, textures.folder(), warnings));
  } else if (type == "bilinearmesh") {
    shape.mesh = std::make_shared<const AnchoredMesh>(read_bilinear_mesh(params, warnings));
  } else if (type == "loopsubdiv") {
    shape.mesh = std::make_shared<const AnchoredMesh>(read_subdivision(params, warnings));
  } else if (type == "curve") {
    shape.mesh = std::make_shared<const AnchoredMesh>(
        read_pbrt_curve(params, max_scene_triangles, warnings));
  } else if (type == "cylinder") {
    has_area = read_cylinder(params, shape);
  } else if (type == "sphere") {
    has_area = read_sphere(params, shape);
  } else if (type == "disk") {
    has_area = read_disk(params, shape);
  } else {
    warnings.add("shape \"" + type + "\" is not supported: left out");
    return false;
  }
  if (!has_area) warnings.add(params.owner + " without area is left out");
  const bool is_visible = read_alpha(params, shines, textures, warnings, shape);
  params.warn_unread(warnings);
  return has_area && is_visible;
}

}  // namespace troffer
