#include "import/mesh/ply.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <functional>
#include <limits>
#include <optional>

#include "base/error.h"
#include "base/parallel.h"
#include "import/file.h"
#include "import/mesh/ply_body.h"
#include "import/mesh/ply_pieces.h"

namespace troffer {

namespace {

// Component that a vertex property sets: x y z nx ny nz u v, or none.
enum Slot : int { slot_x = 0, slot_nx = 3, slot_u = 6, slot_v = 7, slot_count = 8, slot_none = 8 };

int slot_of(const PlyProperty& property) {
  if (property.is_list) return slot_none;
  const std::string& n = property.name;
  constexpr std::array<std::string_view, 6> vectors{"x", "y", "z", "nx", "ny", "nz"};
  for (size_t i = 0; i < vectors.size(); ++i)
    if (n == vectors[i]) return int(i);
  if (n == "u" || n == "s" || n == "texture_u" || n == "texture_s") return slot_u;
  if (n == "v" || n == "t" || n == "texture_v" || n == "texture_t") return slot_v;
  return slot_none;
}

// Triangles of consecutive face rows.
struct FaceRows {
  std::vector<Triangle> triangles;
  size_t short_faces = 0;
};

class PlyReader {
 public:
  PlyReader(const std::string& file, std::string_view text, WarningLog& warnings,
            const PlyLimits& limits)
      : file_(file),
        text_(text),
        header_(parse_ply_header(text, file)),
        body_(text, header_.body, header_.body_line, header_.format, file),
        cutter_(text, header_, file, limits.pieces.piece_bytes),
        progress_(limits.pieces.progress, file_progress, 1, text.size()),
        warnings_(warnings),
        max_triangles_(limits.max_triangles) {}
  AnchoredMesh read();

 private:
  const std::string& file_;
  std::string_view text_;
  PlyHeader header_;
  PlyBody body_;
  PlyCutter cutter_;
  ReadProgress progress_;
  WarningLog& warnings_;
  size_t max_triangles_;
  AnchoredMesh anchored_;
  Mesh& mesh_ = anchored_.mesh;
  bool has_vertices_ = false;
  size_t short_faces_ = 0;

  void check_count(const PlyElement& element) const;
  bool read_in_pieces(const std::vector<PlyPiece>& pieces,
                      const std::function<void(size_t piece, PlyBody& body)>& read);
  std::optional<std::vector<PlyPiece>> cut(const PlyElement& element);
  void go_past(const std::vector<PlyPiece>& pieces);
  void read_vertices(const PlyElement& element);
  void read_faces(const PlyElement& element);
  bool read_faces_in_pieces(const PlyElement& element, const PlyProperty& indices);
  void read_face_rows(PlyBody& body, const PlyElement& element, const PlyProperty& indices,
                      uint64_t rows, FaceRows& out) const;
  void read_face(PlyBody& body, const PlyProperty& property, std::vector<uint32_t>& polygon,
                 FaceRows& out) const;
  void skip_element(const PlyElement& element);
  void check_indices() const;
};

// Throws InputError if the file is too short for the element's count, before memory is allocated.
void PlyReader::check_count(const PlyElement& element) const {
  uint64_t row = 0;
  for (const PlyProperty& p : element.properties)
    row += body_.is_ascii() ? 2 : size_of(p.is_list ? p.count_type : p.type);
  // The last number of an ascii file needs no blank after it.
  const uint64_t available = body_.remaining() + (body_.is_ascii() ? 1 : 0);
  if (row > 0 && element.count > available / row)
    throw InputError(file_, 0, 0,
                     "the file is too short for " + std::to_string(element.count) + " elements '" +
                         element.name + "'");
}

// Reads the pieces in parallel. Returns false if a piece does not hold exactly its rows, or is
// malformed. The caller then reads row by row, which finds the first error and its position.
bool PlyReader::read_in_pieces(const std::vector<PlyPiece>& pieces,
                               const std::function<void(size_t, PlyBody&)>& read) {
  std::atomic<bool> is_sound{true};
  parallel_for(pieces.size(), 0, [&](size_t i) {
    if (!is_sound) return;
    PlyBody body(text_.substr(0, pieces[i].end), pieces[i].begin, 0, header_.format, file_);
    try {
      read(i, body);
      if (!body.is_done()) is_sound = false;
      progress_.add(pieces[i].end - pieces[i].begin);
    } catch (const InputError&) {
      is_sound = false;
    }
  });
  return is_sound;
}

// Cuts an element into pieces. In an ascii body they start at its first scalar, which must be the
// first on its line.
std::optional<std::vector<PlyPiece>> PlyReader::cut(const PlyElement& element) {
  if (element.count == 0 || body_.is_done()) return std::nullopt;
  return cutter_.cut(element, body_.at());
}

void PlyReader::go_past(const std::vector<PlyPiece>& pieces) {
  int lines = 0;
  for (const PlyPiece& p : pieces) lines += p.lines;
  if (!pieces.empty()) body_.go_past_last_scalar(pieces.back().end, lines);
}

void PlyReader::skip_element(const PlyElement& element) {
  warnings_.add(file_ + ": PLY element '" + element.name + "' is skipped");
  if (element.properties.empty()) return;
  for (uint64_t i = 0; i < element.count; ++i)
    for (const PlyProperty& p : element.properties) body_.skip(p);
}

void PlyReader::read_vertices(const PlyElement& element) {
  std::vector<int> slots;
  std::array<bool, slot_count + 1> has{};
  for (const PlyProperty& p : element.properties) {
    slots.push_back(slot_of(p));
    has[size_t(slots.back())] = true;
  }
  if (!(has[0] && has[1] && has[2])) throw InputError(file_, 0, 0, "vertices without x, y and z");
  has_vertices_ = true;
  const bool has_normals = has[3] && has[4] && has[5];
  const bool has_uvs = has[slot_u] && has[slot_v];
  if (element.count > std::numeric_limits<uint32_t>::max())
    throw InputError(file_, 0, 0, "too many vertices");
  const auto n = size_t(element.count);
  std::vector<Vec3d> positions(n);
  if (has_normals) mesh_.normals.resize(n);
  if (has_uvs) mesh_.uvs.resize(n);
  const auto read_rows = [&](PlyBody& body, size_t first, size_t rows) {
    std::array<double, slot_count + 1> row{};
    for (size_t i = first; i < first + rows; ++i) {
      for (size_t k = 0; k < slots.size(); ++k) {
        if (element.properties[k].is_list)
          body.skip(element.properties[k]);
        else
          row[size_t(slots[k])] = body.next(element.properties[k].type);
      }
      positions[i] = {row[0], row[1], row[2]};
      if (has_normals) mesh_.normals[i] = Vec3(Vec3d{row[3], row[4], row[5]});
      if (has_uvs) mesh_.uvs[i] = Vec2(Vec2d{row[slot_u], row[slot_v]});
    }
  };
  const auto pieces = cut(element);
  if (pieces && read_in_pieces(*pieces, [&](size_t i, PlyBody& body) {
        read_rows(body, size_t((*pieces)[i].first_row), size_t((*pieces)[i].rows));
      }))
    go_past(*pieces);
  else
    read_rows(body_, 0, n);
  set_positions(anchored_, positions);
}

void PlyReader::read_face(PlyBody& body, const PlyProperty& property,
                          std::vector<uint32_t>& polygon, FaceRows& out) const {
  const size_t n = body.list_length(property);
  polygon.clear();
  for (size_t i = 0; i < n; ++i) {
    const double index = body.next(property.type);
    if (!(index >= 0 && index <= double(std::numeric_limits<uint32_t>::max())))
      body.fail("vertex index out of range");
    // If the vertices are already read, the message can point at the index.
    if (has_vertices_ && index >= double(mesh_.positions.size()))
      body.fail("vertex index out of range");
    polygon.push_back(uint32_t(index));
  }
  if (n < 3) {
    ++out.short_faces;
    return;
  }
  if (n - 2 > max_triangles_ - out.triangles.size()) body.fail("too many triangles");
  for (size_t i = 2; i < n; ++i) out.triangles.push_back({polygon[0], polygon[i - 1], polygon[i]});
}

void PlyReader::read_face_rows(PlyBody& body, const PlyElement& element, const PlyProperty& indices,
                               uint64_t rows, FaceRows& out) const {
  out.triangles.reserve(std::min(size_t(rows), max_triangles_));
  std::vector<uint32_t> polygon;
  for (uint64_t i = 0; i < rows; ++i) {
    for (const PlyProperty& p : element.properties) {
      if (&p == &indices)
        read_face(body, p, polygon, out);
      else
        body.skip(p);
    }
  }
}

bool PlyReader::read_faces_in_pieces(const PlyElement& element, const PlyProperty& indices) {
  const auto pieces = cut(element);
  if (!pieces) return false;
  std::vector<FaceRows> read(pieces->size());
  if (!read_in_pieces(*pieces, [&](size_t i, PlyBody& body) {
        read_face_rows(body, element, indices, (*pieces)[i].rows, read[i]);
      }))
    return false;
  std::vector<size_t> firsts{0};
  for (const FaceRows& rows : read) firsts.push_back(firsts.back() + rows.triangles.size());
  if (firsts.back() > max_triangles_) return false;
  mesh_.triangles.resize(firsts.back());
  parallel_for(read.size(), 0, [&](size_t i) {
    std::copy(read[i].triangles.begin(), read[i].triangles.end(),
              mesh_.triangles.begin() + std::ptrdiff_t(firsts[i]));
    read[i].triangles = {};
  });
  for (const FaceRows& rows : read) short_faces_ += rows.short_faces;
  go_past(*pieces);
  return true;
}

void PlyReader::read_faces(const PlyElement& element) {
  const PlyProperty* indices = nullptr;
  for (const PlyProperty& p : element.properties) {
    if (p.name != "vertex_indices" && p.name != "vertex_index") continue;
    if (!p.is_list || !is_integer(p.type))
      throw InputError(file_, 0, 0, "'" + p.name + "' must be a list of integers");
    indices = &p;
  }
  if (!indices) {
    if (element.count > 0) throw InputError(file_, 0, 0, "faces without a list of vertex_indices");
    return;
  }
  if (read_faces_in_pieces(element, *indices)) return;
  FaceRows all;
  read_face_rows(body_, element, *indices, element.count, all);
  mesh_.triangles = std::move(all.triangles);
  short_faces_ = all.short_faces;
}

void PlyReader::check_indices() const {
  for (const Triangle& t : mesh_.triangles)
    for (const uint32_t v : t)
      if (v >= mesh_.positions.size())
        throw InputError(file_, 0, 0, "vertex index " + std::to_string(v) + " out of range");
}

AnchoredMesh PlyReader::read() {
  bool has_faces = false, is_checked = true;
  for (const PlyElement& element : header_.elements) {
    check_count(element);
    if (element.name == "vertex" && !has_vertices_) {
      read_vertices(element);
    } else if (element.name == "face" && !has_faces) {
      is_checked = has_vertices_;
      read_faces(element);
      has_faces = true;
    } else {
      skip_element(element);
    }
  }
  if (!has_vertices_) throw InputError(file_, 0, 0, "no vertices in this file");
  if (!is_checked) check_indices();
  if (short_faces_ > 0)
    warnings_.add(file_ + ": face with fewer than three vertices, left out", short_faces_);
  if (mesh_.triangles.empty()) warnings_.add(file_ + ": no triangles in this file");
  return std::move(anchored_);
}

}  // namespace

AnchoredMesh read_ply(const std::string& path, WarningLog& warnings, const PlyLimits& limits) {
  const FileBytes bytes(path, default_max_file_bytes, limits.pieces.progress);
  return PlyReader(path, bytes.view(), warnings, limits).read();
}

}  // namespace troffer
