#include "import/mesh/obj.h"

#include <algorithm>
#include <optional>
#include <unordered_map>
#include <unordered_set>

#include "base/error.h"
#include "base/parallel.h"
#include "import/emissive.h"
#include "import/file.h"
#include "import/mesh/mtl_convert.h"
#include "import/mesh/mtl_image.h"
#include "import/mesh/obj_lines.h"
#include "import/mesh/obj_parts.h"
#include "import/mesh/obj_piece.h"
#include "import/mesh_clean.h"
#include "import/recentre.h"
#include "import/text_lines.h"
#include "import/vertex_paint.h"

namespace troffer {

namespace {

constexpr size_t obj_pieces_per_thread = 8, obj_vertices_at_once = size_t(1) << 16;

// Pieces that are read in parallel. Their triangles join the parts, in order, while the next wave
// is being read.
struct ObjWave {
  size_t first = 0, count = 0;
  std::vector<ObjPiece> pieces;
  std::vector<uint8_t> is_sound;
  std::vector<ObjCounts> before;
};

class ObjReader {
 public:
  ObjReader(const std::string& path, const PieceReading& how, Scene& scene, PlacedBounds& bounds)
      : path_(path),
        folder_(folder_of(path)),
        how_(how),
        scene_(scene),
        bounds_(bounds),
        materials_(scene) {}
  void read();

 private:
  std::string path_, folder_;
  const PieceReading& how_;
  Scene& scene_;
  PlacedBounds& bounds_;                 // box around positions of triangles
  std::vector<std::string_view> texts_;  // one per piece

  struct Vertices {
    std::vector<Vec3d> positions;  // relative to Scene::origin
    std::vector<Vec3> normals;
    std::vector<Vec2> uvs;
    std::vector<Rgb> colors;  // colors of the first positions; further ones are white
  } vertices_;
  ObjParts parts_;
  ObjCounts counts_;
  size_t lights_ = 0;
  struct LeftOut {
    size_t points_and_lines = 0, short_faces = 0, dangling = 0;
  } left_out_;
  struct Materials {
    explicit Materials(Scene& scene) : loader(scene), painter(scene) { loader.convert_to_srgb(); }
    TextureLoader loader;
    VertexPainter painter;
    MtlLibrary library;
    std::unordered_map<std::string, MtlConverted> converted;
    std::unordered_map<std::string, uint32_t> index;
    std::unordered_set<std::string> expected;  // materials whose images are expected
  } materials_;

  void read_pieces();
  void add_vertices(ObjWave& wave);
  void place_faces(ObjWave& wave);
  void add_triangles(const ObjWave& wave);
  void add_triangles(const ObjPiece& piece);
  [[noreturn]] void fail_in(const ObjWave& wave, size_t piece);
  void apply(const ObjEvent& event);
  void expect_images_of(const std::string& material);
  void read_libraries(std::string names);
  bool read_library(const std::string& name);
  bool read_beside(const std::string& name);
  const MtlConverted& material_named(const std::string& name);
  void finish();
  Mesh mesh_of(const ObjPart& part) const;
  void finish_part(ObjPart& part);
  void paint(const ObjPart& part, Mesh& mesh, bool needs_uvs);
};

void ObjReader::read() {
  {
    const FileBytes file(path_, default_max_file_bytes, how_.progress);
    std::string converted;
    std::string_view text = file.view();
    if (!is_utf8(text)) text = converted = as_utf8(text);
    texts_ = cut_at_lines(text, how_.piece_bytes == 0 ? text.size() : how_.piece_bytes);
    read_pieces();
  }
  finish();
}

void ObjReader::read_pieces() {
  const size_t at_once = obj_pieces_per_thread * size_t(thread_count(0));
  ReadProgress progress(how_.progress, file_progress, 1, texts_.size());
  ObjWave now, next;
  for (size_t first = 0; first < texts_.size() || now.count > 0; first += now.count) {
    next.first = first;
    next.count = std::min(at_once, texts_.size() - first);
    next.pieces.resize(std::max(next.count, next.pieces.size()));
    next.is_sound.assign(next.count, 0);
    parallel_for(next.count + 1, 0, [&](size_t i) {
      if (i == 0) {
        add_triangles(now);
        return;
      }
      const size_t k = i - 1, piece = first + k;
      next.is_sound[k] = read_obj_lines(path_, texts_[piece], piece == 0, next.pieces[k]) ? 1 : 0;
    });
    add_vertices(next);
    place_faces(next);
    progress.add(next.count);
    std::swap(now, next);
  }
}

// Appends the vertices of the pieces before the first unsound one. The counts before later pieces
// are unknown.
void ObjReader::add_vertices(ObjWave& wave) {
  wave.before.clear();
  for (size_t i = 0; i < wave.count; ++i) {
    wave.before.push_back(counts_);
    if (wave.is_sound[i] == 0) break;
    counts_.add(wave.pieces[i].counts);
  }
  vertices_.positions.resize(counts_.positions);
  vertices_.normals.resize(counts_.normals);
  vertices_.uvs.resize(counts_.uvs);
  parallel_for(wave.before.size(), 0, [&](size_t i) {
    const ObjPiece& piece = wave.pieces[i];
    const ObjCounts& before = wave.before[i];
    if (wave.is_sound[i] == 0) return;
    Vec3d* position = vertices_.positions.data() + before.positions;
    for (const Vec3d& p : piece.positions) *position++ = p - scene_.origin;
    std::copy(piece.normals.begin(), piece.normals.end(),
              vertices_.normals.begin() + std::ptrdiff_t(before.normals));
    std::copy(piece.uvs.begin(), piece.uvs.end(),
              vertices_.uvs.begin() + std::ptrdiff_t(before.uvs));
  });
  for (size_t i = 0; i < wave.before.size(); ++i) {
    const std::vector<Rgb>& colors = wave.pieces[i].colors;
    if (wave.is_sound[i] == 0 || colors.empty()) continue;
    vertices_.colors.resize(wave.before[i].positions, Rgb{1});
    vertices_.colors.insert(vertices_.colors.end(), colors.begin(), colors.end());
  }
}

void ObjReader::place_faces(ObjWave& wave) {
  parallel_for(wave.before.size(), 0, [&](size_t i) {
    if (wave.is_sound[i] != 0 &&
        !place_obj_faces(wave.before[i], vertices_.positions, wave.pieces[i]))
      wave.is_sound[i] = 0;
  });
}

void ObjReader::add_triangles(const ObjWave& wave) {
  for (size_t i = 0; i < wave.count; ++i) {
    if (wave.is_sound[i] == 0) fail_in(wave, i);
    add_triangles(wave.pieces[i]);
  }
}

void ObjReader::add_triangles(const ObjPiece& piece) {
  size_t done = 0;
  const auto add_up_to = [&](size_t triangle) {
    parts_.add(piece.corners.data() + 3 * done, triangle - done, vertices_.positions.size());
    done = triangle;
  };
  for (const ObjEvent& event : piece.events) {
    add_up_to(event.triangle);
    apply(event);
  }
  add_up_to(piece.corners.size() / 3);
  bounds_.add(piece.bounds);
  left_out_.points_and_lines += piece.points_and_lines;
  left_out_.short_faces += piece.short_faces;
  left_out_.dangling += piece.dangling;
}

// Throws the first error of piece i by parsing it again with the counts before it. Statements
// before the error are applied first, because a material library may hold an earlier error.
void ObjReader::fail_in(const ObjWave& wave, size_t i) {
  ObjPiece piece;
  try {
    read_obj_lines_after(wave.before[i], path_, texts_[wave.first + i], piece);
  } catch (const InputError&) {
    for (const ObjEvent& event : piece.events) apply(event);
    throw;
  }
  TROFFER_CHECK(false);
}

void ObjReader::apply(const ObjEvent& event) {
  using Kind = ObjEvent::Kind;
  switch (event.kind) {
    case Kind::object:
      return parts_.set_object(event.text);
    case Kind::group:
      return parts_.set_group(event.text);
    case Kind::material:
      expect_images_of(event.text);
      return parts_.set_material(event.text);
    case Kind::library:
      return read_libraries(event.text);
    case Kind::unsupported:
      return scene_.warnings.add("OBJ: '" + event.text + "' is not supported: left out",
                                 event.count);
    case Kind::colors_begin:
      return parts_.begin_colors();
  }
}

void ObjReader::expect_images_of(const std::string& material) {
  const auto found = materials_.library.find(material);
  if (found == materials_.library.end() || !materials_.expected.insert(material).second) return;
  expect_mtl_images(found->second, folder_, materials_.loader);
}

// Reads the libraries of a mtllib statement. Names may contain blanks, so the whole line is tried
// first, then each part up to ".mtl".
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

// Reads a library of that file name beside the scene. Paths often refer to another machine.
bool ObjReader::read_beside(const std::string& name) {
  const std::string path = path_beside(folder_, name);
  if (path.empty()) return false;
  scene_.warnings.add("material library '" + name.substr(0, 200) +
                      "' cannot be read; the one beside the scene is used");
  read_mtl(path, "", materials_.library, scene_.warnings);
  return true;
}

// Returns false if there is no such file or it must not be read.
bool ObjReader::read_library(const std::string& name) {
  const ConfinedPath path = confined_path(folder_, name);
  if (!path.is_fine()) return false;
  const size_t slash = name.rfind('/');
  const std::string subfolder = slash == std::string::npos ? "" : name.substr(0, slash + 1);
  try {
    read_mtl(path.path, subfolder, materials_.library, scene_.warnings);
  } catch (const InputError& error) {
    if (error.line() > 0) throw;  // malformed rather than missing
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
    made = convert_mtl(found->second, folder_, materials_.loader, scene_);
  } else {
    made.material.name = name.empty() ? "default" : name;
    if (!name.empty())
      scene_.warnings.add("material '" + name.substr(0, 200) + "' is missing: shown grey");
  }
  materials_.index[name] = uint32_t(scene_.materials.size());
  scene_.materials.push_back(made.material);
  return materials_.converted[name] = std::move(made);
}

Mesh ObjReader::mesh_of(const ObjPart& part) const {
  Mesh mesh;
  mesh.name = part.name;
  const size_t n = part.vertices.size();
  mesh.positions.resize(n);
  if (part.has_uvs) mesh.uvs.resize(n);
  if (part.has_normals) mesh.normals.resize(n);
  parallel_pieces(n, obj_vertices_at_once, [&](size_t first, size_t end) {
    for (size_t i = first; i < end; ++i) {
      const ObjCorner& c = part.vertices[i].corner;
      mesh.positions[i] = Vec3(vertices_.positions[c.position]);
      if (c.uv != obj_nothing) mesh.uvs[i] = vertices_.uvs[c.uv];
      if (c.normal != obj_nothing) mesh.normals[i] = vertices_.normals[c.normal];
    }
  });
  return mesh;
}

void ObjReader::finish_part(ObjPart& part) {
  Mesh mesh = mesh_of(part);
  mesh.triangles = std::move(part.triangles);
  const MtlConverted& material = material_named(part.material);
  mesh.material = materials_.index[part.material];
  if (part.is_painted) paint(part, mesh, material.emission_texture >= 0);
  part.vertices = {};
  clean_mesh(mesh, scene_.warnings);
  const auto index = uint32_t(scene_.meshes.size());
  const bool is_empty = mesh.triangles.empty();
  if (!is_empty) scene_.meshes.push_back(std::move(mesh));
  if (material.emission.is_black()) return;
  // A source without area keeps its number, so that names depend on the file alone.
  const std::string name = "emitter" + std::to_string(lights_++);
  if (is_empty)
    scene_.warnings.add("area light without area is left out");
  else
    add_mesh_lights(scene_, index, {name, material.emission, material.emission_texture, false});
}

// Applies vertex colours: they multiply the material's colour, or replace it if there is no
// material.
void ObjReader::paint(const ObjPart& part, Mesh& mesh, bool needs_uvs) {
  std::vector<TextureValue> colors(part.vertices.size());  // white by default
  for (size_t i = 0; i < colors.size(); ++i) {
    const uint32_t position = part.vertices[i].corner.position;
    if (position < vertices_.colors.size()) colors[i].rgb = vertices_.colors[position];
  }
  if (!materials_.library.contains(part.material)) {
    scene_.materials.push_back(Material(scene_.materials[mesh.material]));
    scene_.materials.back().base_color.value = Rgb{1};
    mesh.material = uint32_t(scene_.materials.size() - 1);
  }
  materials_.painter.paint(mesh, colors, needs_uvs);
}

void ObjReader::finish() {
  if (left_out_.points_and_lines > 0)
    scene_.warnings.add("OBJ: points and lines are left out", left_out_.points_and_lines);
  if (left_out_.short_faces > 0)
    scene_.warnings.add("OBJ: faces of fewer than three vertices are left out",
                        left_out_.short_faces);
  if (left_out_.dangling > 0)
    scene_.warnings.add("OBJ: faces refer to normals or texture coordinates, but there are none",
                        left_out_.dangling);
  for (const auto& part : parts_.all()) finish_part(*part);
}

}  // namespace

Scene import_obj(const std::string& path, const PieceReading& how, ImageUse images) {
  return import_recentred(
      [&](Scene& scene, PlacedBounds& bounds) {
        scene.file = path;
        ObjReader(path, how, scene, bounds).read();
      },
      images);
}

}  // namespace troffer
