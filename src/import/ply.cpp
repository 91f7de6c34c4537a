#include "import/ply.h"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/error.h"
#include "import/file.h"
#include "import/ply_header.h"

namespace troffer {

namespace {

// Where a vertex property goes: x y z nx ny nz u v, or nowhere.
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

// Scalars of the body, one after the other, in any of the three encodings.
class BodyReader {
 public:
  BodyReader(std::string_view text, const PlyHeader& header, const std::string& file)
      : text_(text),
        at_(header.body),
        line_start_(header.body),
        line_(header.body_line),
        format_(header.format),
        file_(file) {}

  double next(PlyType type) {
    return format_ == PlyFormat::ascii ? next_ascii(type) : next_binary(type);
  }
  size_t remaining() const { return text_.size() - at_; }
  bool is_ascii() const { return format_ == PlyFormat::ascii; }
  // At the scalar read last.
  [[noreturn]] void fail(const std::string& what) const {
    if (!is_ascii()) throw InputError(file_, 0, 0, what);
    throw InputError(file_, line_, int(last_ - line_start_) + 1, what);
  }

 private:
  std::string_view text_;
  size_t at_, last_ = 0, line_start_;
  int line_;
  PlyFormat format_;
  const std::string& file_;

  double next_ascii(PlyType type);
  double next_binary(PlyType type);
};

double BodyReader::next_ascii(PlyType type) {
  for (; at_ < text_.size(); ++at_) {
    const char c = text_[at_];
    if (c == '\n') {
      ++line_;
      line_start_ = at_ + 1;
    } else if (c != ' ' && c != '\t' && c != '\r') {
      break;
    }
  }
  last_ = at_;
  if (at_ == text_.size()) fail("the file ends early");
  const char* begin = text_.data() + at_;
  const char* const end = text_.data() + text_.size();
  if (*begin == '+' && begin + 1 < end && begin[1] != '-') ++begin;
  double value = 0;
  const auto result = std::from_chars(begin, end, value);
  const bool is_whole = result.ptr == end || *result.ptr == ' ' || *result.ptr == '\t' ||
                        *result.ptr == '\r' || *result.ptr == '\n';
  if (result.ec == std::errc::invalid_argument || !is_whole) fail("expected a number");
  if (result.ec == std::errc::result_out_of_range)
    value = std::strtod(std::string(begin, result.ptr).c_str(), nullptr);
  at_ = size_t(result.ptr - text_.data());
  if (is_integer(type) && std::floor(value) != value) fail("expected an integer");
  return value;
}

template <class T>
double scalar_from(uint64_t bits) {
  if constexpr (sizeof(T) == 8)
    return double(std::bit_cast<T>(bits));
  else if constexpr (std::is_same_v<T, float>)
    return double(std::bit_cast<float>(uint32_t(bits)));
  else
    return double(T(bits));
}

double BodyReader::next_binary(PlyType type) {
  const size_t size = size_of(type);
  if (remaining() < size) fail("the file ends early");
  uint64_t bits = 0;
  for (size_t i = 0; i < size; ++i) {
    const size_t k = format_ == PlyFormat::little_endian ? i : size - 1 - i;
    bits |= uint64_t(static_cast<unsigned char>(text_[at_ + i])) << (8 * k);
  }
  at_ += size;
  switch (type) {
    case PlyType::int8:
      return scalar_from<int8_t>(bits);
    case PlyType::uint8:
      return scalar_from<uint8_t>(bits);
    case PlyType::int16:
      return scalar_from<int16_t>(bits);
    case PlyType::uint16:
      return scalar_from<uint16_t>(bits);
    case PlyType::int32:
      return scalar_from<int32_t>(bits);
    case PlyType::uint32:
      return scalar_from<uint32_t>(bits);
    case PlyType::float32:
      return scalar_from<float>(bits);
    case PlyType::float64:
      return scalar_from<double>(bits);
  }
  return 0;
}

class PlyReader {
 public:
  PlyReader(const std::string& file, std::string_view text, WarningLog& warnings,
            size_t max_triangles)
      : file_(file),
        header_(parse_ply_header(text, file)),
        body_(text, header_, file),
        warnings_(warnings),
        max_triangles_(max_triangles) {}
  AnchoredMesh read();

 private:
  const std::string& file_;
  PlyHeader header_;
  BodyReader body_;
  WarningLog& warnings_;
  size_t max_triangles_;
  AnchoredMesh anchored_;
  Mesh& mesh_ = anchored_.mesh;
  bool has_vertices_ = false;
  size_t short_faces_ = 0;

  void check_count(const PlyElement& element) const;
  size_t list_length(const PlyProperty& property);
  void skip(const PlyProperty& property);
  void read_vertices(const PlyElement& element);
  void read_faces(const PlyElement& element);
  void read_face(const PlyProperty& property, std::vector<uint32_t>& polygon);
  void skip_element(const PlyElement& element);
  void check_indices() const;
};

// Refuses counts for which the file is too short, before anything is allocated for them.
void PlyReader::check_count(const PlyElement& element) const {
  uint64_t row = 0;
  for (const PlyProperty& p : element.properties)
    row += body_.is_ascii() ? 2 : size_of(p.is_list ? p.count_type : p.type);
  // The last number of an ascii file needs no blank behind it.
  const uint64_t available = body_.remaining() + (body_.is_ascii() ? 1 : 0);
  if (row > 0 && element.count > available / row)
    throw InputError(file_, 0, 0,
                     "the file is too short for " + std::to_string(element.count) + " elements '" +
                         element.name + "'");
}

size_t PlyReader::list_length(const PlyProperty& property) {
  const double length = body_.next(property.count_type);
  const double smallest = body_.is_ascii() ? 2 : double(size_of(property.type));
  if (!(length >= 0)) body_.fail("a list of negative length");
  if (length * smallest > double(body_.remaining()) + 1)
    body_.fail("the file is too short for a list of this length");
  return size_t(length);
}

void PlyReader::skip(const PlyProperty& property) {
  const size_t n = property.is_list ? list_length(property) : 1;
  for (size_t i = 0; i < n; ++i) body_.next(property.type);
}

void PlyReader::skip_element(const PlyElement& element) {
  warnings_.add(file_ + ": PLY element '" + element.name + "' is skipped");
  if (element.properties.empty()) return;
  for (uint64_t i = 0; i < element.count; ++i)
    for (const PlyProperty& p : element.properties) skip(p);
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
  std::array<double, slot_count + 1> row{};
  for (size_t i = 0; i < n; ++i) {
    for (size_t k = 0; k < slots.size(); ++k) {
      if (element.properties[k].is_list)
        skip(element.properties[k]);
      else
        row[size_t(slots[k])] = body_.next(element.properties[k].type);
    }
    positions[i] = {row[0], row[1], row[2]};
    if (has_normals) mesh_.normals[i] = Vec3(Vec3d{row[3], row[4], row[5]});
    if (has_uvs) mesh_.uvs[i] = Vec2(Vec2d{row[slot_u], row[slot_v]});
  }
  set_positions(anchored_, positions);
}

void PlyReader::read_face(const PlyProperty& property, std::vector<uint32_t>& polygon) {
  const size_t n = list_length(property);
  polygon.clear();
  for (size_t i = 0; i < n; ++i) {
    const double index = body_.next(property.type);
    if (!(index >= 0 && index <= double(std::numeric_limits<uint32_t>::max())))
      body_.fail("vertex index out of range");
    // Where the vertices are known already, the message can point at the index.
    if (has_vertices_ && index >= double(mesh_.positions.size()))
      body_.fail("vertex index out of range");
    polygon.push_back(uint32_t(index));
  }
  if (n < 3) {
    ++short_faces_;
    return;
  }
  if (n - 2 > max_triangles_ - mesh_.triangles.size()) body_.fail("too many triangles");
  for (size_t i = 2; i < n; ++i)
    mesh_.triangles.push_back({polygon[0], polygon[i - 1], polygon[i]});
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
  mesh_.triangles.reserve(std::min(size_t(element.count), max_triangles_));
  std::vector<uint32_t> polygon;
  for (uint64_t i = 0; i < element.count; ++i) {
    for (const PlyProperty& p : element.properties) {
      if (&p == indices)
        read_face(p, polygon);
      else
        skip(p);
    }
  }
}

void PlyReader::check_indices() const {
  for (const Triangle& t : mesh_.triangles)
    for (const uint32_t v : t)
      if (v >= mesh_.positions.size())
        throw InputError(file_, 0, 0, "vertex index " + std::to_string(v) + " out of range");
}

AnchoredMesh PlyReader::read() {
  bool has_faces = false;
  for (const PlyElement& element : header_.elements) {
    check_count(element);
    if (element.name == "vertex" && !has_vertices_) {
      read_vertices(element);
    } else if (element.name == "face" && !has_faces) {
      read_faces(element);
      has_faces = true;
    } else {
      skip_element(element);
    }
  }
  if (!has_vertices_) throw InputError(file_, 0, 0, "no vertices in this file");
  check_indices();
  if (short_faces_ > 0)
    warnings_.add(file_ + ": face with fewer than three vertices, left out", short_faces_);
  if (mesh_.triangles.empty()) warnings_.add(file_ + ": no triangles in this file");
  return std::move(anchored_);
}

}  // namespace

AnchoredMesh read_ply(const std::string& path, WarningLog& warnings, size_t max_triangles) {
  const std::string text = read_text_file(path);
  return PlyReader(path, text, warnings, max_triangles).read();
}

}  // namespace troffer
