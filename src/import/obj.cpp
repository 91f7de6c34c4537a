#include "import/obj.h"

#include <algorithm>
#include <array>
#include <memory>
#include <unordered_map>

#include "base/error.h"
#include "import/emissive.h"
#include "import/file.h"
#include "import/limits.h"
#include "import/mesh_clean.h"
#include "import/mtl.h"
#include "import/polygon.h"
#include "import/recentre.h"
#include "import/text_lines.h"
#include "import/vertex_paint.h"

namespace troffer {

namespace {

constexpr uint32_t nothing = 0xffffffffu;

// Indices of one corner of a face, from 0; `nothing` where not given.
struct Corner {
  uint32_t position = nothing, uv = nothing, normal = nothing;
};

// A mesh being built, of one object, group and material.
struct Part {
  std::string material;
  Mesh mesh;
  std::vector<TextureValue> colors;  // empty, or per vertex
  bool has_uvs = false, has_normals = false;
  // Per vertex: the other two indices it was made of, and the next vertex at the same position.
  struct Made {
    uint32_t uv, normal, next;
  };
  std::vector<Made> made;
};

class ObjReader {
 public:
  ObjReader(const std::string& path, Scene& scene, PlacedBounds& bounds)
      : path_(path),
        folder_(folder_of(path)),
        scene_(scene),
        text_(as_utf8(read_text_file(path))),
        lines_(path_, text_),
        loader_(scene),
        materials_(scene) {
    vertices_.bounds = &bounds;
  }
  void read();

 private:
  std::string path_, folder_;
  Scene& scene_;
  std::string text_;
  TextLines lines_;
  TextureLoader loader_;

  struct Vertices {
    PlacedBounds* bounds = nullptr;  // of those in triangles
    std::vector<Vec3d> positions;    // from the scene's origin
    std::vector<Vec3> normals;
    std::vector<Vec2> uvs;
    std::vector<Rgb> colors;  // of the first positions; white of further ones
  } vertices_;
  struct Names {
    std::string object, group, material;
  } names_;
  // First vertex of the current part at each position, valid where the stamp is the part's.
  struct First {
    uint32_t stamp = 0, vertex = nothing;
  };
  struct Parts {
    std::vector<std::unique_ptr<Part>> all;
    std::unordered_map<std::string, Part*> by_key;
    Part* current = nullptr;  // where faces go; null after a change of names
    std::vector<First> firsts;
    uint32_t stamp = 0;
  } parts_;
  struct Counts {
    size_t triangles = 0, lights = 0, points_and_lines = 0, short_faces = 0, dangling = 0;
  } counts_;
  struct Face {
    std::vector<Corner> corners;
    std::vector<Vec3> points;
    std::vector<Triangle> triangles;
  } face_;
  struct Materials {
    explicit Materials(Scene& scene) : painter(scene) {}
    VertexPainter painter;
    MtlLibrary library;
    std::unordered_map<std::string, MtlConverted> converted;
    std::unordered_map<std::string, uint32_t> index;
  } materials_;

  void read_statement(std::string_view keyword);
  void read_vertex();
  void read_face();
  void add_triangle(const Triangle& corners);
  uint32_t read_index(size_t count, const char* what, bool is_needed);
  bool read_corner();
  void select_part();
  uint32_t vertex_of(const Corner& corner);
  void read_libraries(std::string names);
  bool read_library(const std::string& name);
  bool read_beside(const std::string& name);
  const MtlConverted& material_named(const std::string& name);
  void finish();
  void finish_part(Part& part);
  void paint(Part& part, bool needs_uvs);
};

void ObjReader::read() {
  while (lines_.next_line()) {
    const std::string_view keyword = lines_.word();
    if (!keyword.empty()) read_statement(keyword);
  }
  finish();
}

void ObjReader::read_statement(std::string_view keyword) {
  if (keyword == "v") {
    read_vertex();
  } else if (keyword == "f" || keyword == "fo") {
    read_face();
  } else if (keyword == "vn") {
    const float x = lines_.number(), y = lines_.number();
    vertices_.normals.emplace_back(x, y, lines_.number());
    if (lines_.has_word()) lines_.fail("a normal has three numbers");
  } else if (keyword == "vt") {
    const float u = lines_.number();
    vertices_.uvs.emplace_back(u, lines_.has_word() ? lines_.number() : 0.0f);
    if (lines_.has_word()) lines_.number();
    if (lines_.has_word()) lines_.fail("texture coordinates have at most three numbers");
  } else if (keyword == "o") {
    names_.object = lines_.rest();
    names_.group.clear();
    parts_.current = nullptr;
  } else if (keyword == "g") {
    names_.group = lines_.rest();
    parts_.current = nullptr;
  } else if (keyword == "usemtl") {
    names_.material = lines_.rest();
    parts_.current = nullptr;
  } else if (keyword == "mtllib") {
    read_libraries(std::string(lines_.rest()));
  } else if (keyword == "p" || keyword == "l") {
    ++counts_.points_and_lines;
  } else if (keyword != "s") {
    for (const char c : keyword)
      if (static_cast<unsigned char>(c) < 32) lines_.fail("this is not a text file");
    scene_.warnings.add("OBJ: '" + std::string(keyword.substr(0, 40)) +
                        "' is not supported: left out");
  }
}

// x y z, then nothing, a weight (left out), a colour (sRGB, as programs mean it) or both.
void ObjReader::read_vertex() {
  const double x = lines_.precise_number(), y = lines_.precise_number();
  vertices_.positions.push_back(Vec3d{x, y, lines_.precise_number()} - scene_.origin);
  std::array<float, 4> v{};
  size_t more = 0;
  for (; lines_.has_word() && more < 4; ++more) v[more] = lines_.number();
  if (more == 2 || lines_.has_word()) lines_.fail("a vertex has 3, 4, 6 or 7 numbers");
  if (more < 3) return;
  vertices_.colors.resize(vertices_.positions.size(), Rgb{1});
  for (size_t k = 0; k < 3; ++k)
    vertices_.colors.back()[k] = linear_from_srgb(std::clamp(v[more - 3 + k], 0.0f, 1.0f));
}

// An index counts from 1, or backwards from -1; the result from 0.
uint32_t ObjReader::read_index(size_t count, const char* what, bool is_needed) {
  int index = 0;
  if (!lines_.integer(index)) lines_.fail(std::string("expected the index of a ") + what);
  // Some files name normals or texture coordinates of which they hold none.
  if (count == 0 && !is_needed) {
    ++counts_.dangling;
    return nothing;
  }
  const int64_t i = index < 0 ? int64_t(count) + index : int64_t(index) - 1;
  if (index == 0 || i < 0 || i >= int64_t(count))
    lines_.fail(std::string("index ") + std::to_string(index) + " of a " + what +
                " is out of range (" + std::to_string(count) + " so far)");
  return uint32_t(i);
}

// v, v/vt, v//vn or v/vt/vn; false at the end of the line.
bool ObjReader::read_corner() {
  if (!lines_.has_word()) return false;
  Corner corner;
  corner.position = read_index(vertices_.positions.size(), "vertex", true);
  if (lines_.peek() == '/') {
    lines_.take();
    if (lines_.peek() != '/')
      corner.uv = read_index(vertices_.uvs.size(), "texture coordinate", false);
    if (lines_.peek() == '/') {
      lines_.take();
      corner.normal = read_index(vertices_.normals.size(), "normal", false);
    }
  }
  const char c = lines_.peek();
  if (c != '\0' && c != ' ' && c != '\t') lines_.fail("malformed corner of a face");
  face_.corners.push_back(corner);
  return true;
}

void ObjReader::select_part() {
  std::string key = names_.object;
  key.append(1, '\0').append(names_.group).append(1, '\0').append(names_.material);
  Part*& part = parts_.by_key[key];
  if (!part) {
    parts_.all.push_back(std::make_unique<Part>());
    part = parts_.all.back().get();
    part->material = names_.material;
    part->mesh.name = names_.group.empty() ? names_.object : names_.group;
  }
  parts_.current = part;
  ++parts_.stamp;
}

uint32_t ObjReader::vertex_of(const Corner& corner) {
  Part& part = *parts_.current;
  First& first = parts_.firsts[corner.position];
  if (first.stamp != parts_.stamp) first = {parts_.stamp, nothing};
  for (uint32_t v = first.vertex; v != nothing; v = part.made[v].next)
    if (part.made[v].uv == corner.uv && part.made[v].normal == corner.normal) return v;
  const auto vertex = uint32_t(part.made.size());
  part.made.push_back({corner.uv, corner.normal, first.vertex});
  first.vertex = vertex;
  part.mesh.positions.emplace_back(vertices_.positions[corner.position]);
  part.mesh.uvs.push_back(corner.uv != nothing ? vertices_.uvs[corner.uv] : Vec2{});
  part.mesh.normals.push_back(corner.normal != nothing ? vertices_.normals[corner.normal] : Vec3{});
  if (!vertices_.colors.empty()) {
    part.colors.resize(size_t(vertex) + 1);  // white where there is none
    if (corner.position < vertices_.colors.size())
      part.colors.back().rgb = vertices_.colors[corner.position];
  }
  part.has_uvs = part.has_uvs || corner.uv != nothing;
  part.has_normals = part.has_normals || corner.normal != nothing;
  return vertex;
}

void ObjReader::read_face() {
  face_.corners.clear();
  while (read_corner()) {
  }
  if (face_.corners.size() < 3) {
    if (face_.corners.empty()) lines_.fail("a face without vertices");
    ++counts_.short_faces;
    return;
  }
  counts_.triangles += face_.corners.size() - 2;
  if (counts_.triangles > max_scene_triangles)
    lines_.fail("more than " + std::to_string(max_scene_triangles / 1'000'000) +
                " million triangles");
  if (!parts_.current) select_part();
  parts_.firsts.resize(vertices_.positions.size());
  if (face_.corners.size() == 3) {
    add_triangle({0, 1, 2});
    return;
  }
  face_.points.clear();
  face_.triangles.clear();
  for (const Corner& c : face_.corners) face_.points.emplace_back(vertices_.positions[c.position]);
  triangulate(face_.points, face_.triangles);
  for (const Triangle& t : face_.triangles) add_triangle(t);
}

// Of three corners of the face.
void ObjReader::add_triangle(const Triangle& corners) {
  const auto position = [&](size_t k) {
    return vertices_.positions[face_.corners[corners[k]].position];
  };
  vertices_.bounds->add_triangle(position(0), position(1), position(2));
  Triangle t;
  for (size_t k = 0; k < 3; ++k) t[k] = vertex_of(face_.corners[corners[k]]);
  parts_.current->mesh.triangles.push_back(t);
}

// Names may contain blanks, and several may follow: the whole line first, then up to each ".mtl".
void ObjReader::read_libraries(std::string names) {
  std::replace(names.begin(), names.end(), '\\', '/');
  if (names.empty() || read_library(names)) return;
  std::string name;
  for (size_t at = 0; at < names.size();) {
    const size_t end = std::min(names.find_first_of(" \t", at), names.size());
    if (!name.empty()) name += ' ';
    name += names.substr(at, end - at);
    at = std::min(names.find_first_not_of(" \t", end), names.size());
    if (lower_case_ending(name) != "mtl" && at < names.size()) continue;
    if ((name == names || !read_library(name)) && !read_beside(name))
      scene_.warnings.add("material library '" + name.substr(0, 200) + "' is missing");
    name.clear();
  }
}

// Paths of another machine: the file may lie beside the scene.
bool ObjReader::read_beside(const std::string& name) {
  const std::string path = path_beside(folder_, name);
  if (path.empty()) return false;
  scene_.warnings.add("material library '" + name.substr(0, 200) +
                      "' cannot be read there; the one beside the scene is");
  read_mtl(path, "", materials_.library, scene_.warnings);
  return true;
}

// False: there is no such file, or it must not be read.
bool ObjReader::read_library(const std::string& name) {
  const ConfinedPath path = confined_path(folder_, name);
  if (!path.is_fine()) return false;
  const size_t slash = name.rfind('/');
  const std::string subfolder = slash == std::string::npos ? "" : name.substr(0, slash + 1);
  try {
    read_mtl(path.path, subfolder, materials_.library, scene_.warnings);
  } catch (const InputError& error) {
    if (error.line() > 0) throw;  // malformed, not missing
    return false;
  }
  return true;
}

const MtlConverted& ObjReader::material_named(const std::string& name) {
  const auto known = materials_.converted.find(name);
  if (known != materials_.converted.end()) return known->second;
  MtlConverted made;
  const auto found = materials_.library.find(name);
  if (found != materials_.library.end()) {
    made = convert_mtl(found->second, folder_, loader_, scene_.textures, scene_.warnings);
  } else {
    made.material.name = name.empty() ? "default" : name;
    if (!name.empty())
      scene_.warnings.add("material '" + name.substr(0, 200) + "' is missing: shown grey");
  }
  materials_.index[name] = uint32_t(scene_.materials.size());
  scene_.materials.push_back(made.material);
  return materials_.converted[name] = std::move(made);
}

void ObjReader::finish_part(Part& part) {
  Mesh& mesh = part.mesh;
  if (!part.has_uvs) mesh.uvs.clear();
  if (!part.has_normals) mesh.normals.clear();
  part.made = {};
  const MtlConverted& material = material_named(part.material);
  mesh.material = materials_.index[part.material];
  paint(part, material.emission_texture >= 0);
  clean_mesh(mesh, scene_.warnings);
  const auto index = uint32_t(scene_.meshes.size());
  const bool is_empty = mesh.triangles.empty();
  if (!is_empty) scene_.meshes.push_back(std::move(mesh));
  if (material.emission.is_black()) return;
  // A source without area keeps its number, so that names do not depend on what else is wrong.
  const std::string name = "emitter" + std::to_string(counts_.lights++);
  if (is_empty)
    scene_.warnings.add("area light without area is left out");
  else
    add_mesh_lights(scene_, index, {name, material.emission, material.emission_texture, false});
}

// Colours of vertices are factors on a material's colour, or the colour where there is none.
void ObjReader::paint(Part& part, bool needs_uvs) {
  if (part.colors.empty()) return;
  if (!materials_.library.contains(part.material)) {
    scene_.materials.push_back(Material(scene_.materials[part.mesh.material]));
    scene_.materials.back().base_color.value = Rgb{1};
    part.mesh.material = uint32_t(scene_.materials.size() - 1);
  }
  materials_.painter.paint(part.mesh, part.colors, needs_uvs);
  part.colors = {};
}

void ObjReader::finish() {
  if (counts_.points_and_lines > 0)
    scene_.warnings.add("OBJ: points and lines are left out", counts_.points_and_lines);
  if (counts_.short_faces > 0)
    scene_.warnings.add("OBJ: faces of fewer than three vertices are left out",
                        counts_.short_faces);
  if (counts_.dangling > 0)
    scene_.warnings.add("OBJ: faces name normals or texture coordinates, but there are none",
                        counts_.dangling);
  vertices_ = {};
  text_ = {};
  for (const auto& part : parts_.all) finish_part(*part);
}

}  // namespace

Scene import_obj(const std::string& path) {
  return import_recentred([&](Scene& scene, PlacedBounds& bounds) {
    scene.file = path;
    ObjReader(path, scene, bounds).read();
  });
}

}  // namespace troffer
