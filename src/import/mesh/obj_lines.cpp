#include "import/mesh/obj_lines.h"

#include <algorithm>
#include <array>

#include "base/error.h"
#include "import/limits.h"
#include "import/text_lines.h"

namespace troffer {

namespace {

class ObjLineReader {
 public:
  // `before` is null if the counts before these lines are unknown.
  ObjLineReader(const std::string& file, std::string_view text, bool is_first,
                const ObjCounts* before, ObjPiece& piece)
      : lines_(file, text, is_first, before != nullptr ? before->lines : 0),
        before_(before),
        piece_(piece) {
    piece_.clear();
  }

  void read() {
    while (lines_.next_line()) {
      const std::string_view keyword = lines_.word();
      if (!keyword.empty()) read_statement(keyword);
    }
    piece_.counts = counts_now();
  }

 private:
  TextLines lines_;
  const ObjCounts* before_;
  ObjPiece& piece_;
  size_t triangles_ = 0;

  ObjCounts counts_now() const {
    return {piece_.positions.size(), piece_.uvs.size(), piece_.normals.size(), triangles_,
            lines_.lines_taken()};
  }
  void read_statement(std::string_view keyword);
  void read_vertex();
  void read_normal();
  void read_uv();
  void read_face();
  bool read_corner();
  int read_index(size_t ObjCounts::*kind, const char* what);
  void add_event(ObjEvent::Kind kind, std::string_view text);
  void add_unsupported(std::string_view keyword);
};

void ObjLineReader::read_statement(std::string_view keyword) {
  using Kind = ObjEvent::Kind;
  if (keyword == "v")
    read_vertex();
  else if (keyword == "f" || keyword == "fo")
    read_face();
  else if (keyword == "vn")
    read_normal();
  else if (keyword == "vt")
    read_uv();
  else if (keyword == "o")
    add_event(Kind::object, lines_.rest());
  else if (keyword == "g")
    add_event(Kind::group, lines_.rest());
  else if (keyword == "usemtl")
    add_event(Kind::material, lines_.rest());
  else if (keyword == "mtllib")
    add_event(Kind::library, lines_.rest());
  else if (keyword == "p" || keyword == "l")
    ++piece_.points_and_lines;
  else if (keyword != "s")
    add_unsupported(keyword);
}

void ObjLineReader::add_event(ObjEvent::Kind kind, std::string_view text) {
  piece_.events.push_back({kind, std::string(text), piece_.sizes.size(), 0, 1});
}

void ObjLineReader::add_unsupported(std::string_view keyword) {
  for (const char c : keyword)
    if (static_cast<unsigned char>(c) < 32) lines_.fail("this is not a text file");
  keyword = keyword.substr(0, 40);
  const bool is_again = !piece_.events.empty() &&
                        piece_.events.back().kind == ObjEvent::Kind::unsupported &&
                        piece_.events.back().text == keyword;
  if (is_again)
    ++piece_.events.back().count;
  else
    add_event(ObjEvent::Kind::unsupported, keyword);
}

// Reads x y z, followed by nothing, a weight (ignored), a colour (sRGB by convention of programs)
// or both.
void ObjLineReader::read_vertex() {
  const double x = lines_.precise_number(), y = lines_.precise_number();
  piece_.positions.emplace_back(x, y, lines_.precise_number());
  std::array<float, 4> v{};
  size_t more = 0;
  for (; lines_.has_word() && more < 4; ++more) v[more] = lines_.number();
  if (more == 2 || lines_.has_word()) lines_.fail("a vertex has 3, 4, 6 or 7 numbers");
  if (more < 3) return;
  if (piece_.colors.empty()) add_event(ObjEvent::Kind::colors_begin, "");
  piece_.colors.resize(piece_.positions.size(), Rgb{1});
  for (size_t k = 0; k < 3; ++k)
    piece_.colors.back()[k] = linear_from_srgb(std::clamp(v[more - 3 + k], 0.0f, 1.0f));
}

void ObjLineReader::read_normal() {
  const float x = lines_.number(), y = lines_.number();
  piece_.normals.emplace_back(x, y, lines_.number());
  if (lines_.has_word()) lines_.fail("a normal has three numbers");
}

void ObjLineReader::read_uv() {
  const float u = lines_.number();
  piece_.uvs.emplace_back(u, lines_.has_word() ? lines_.number() : 0.0f);
  if (lines_.has_word()) lines_.number();
  if (lines_.has_word()) lines_.fail("texture coordinates have at most three numbers");
}

// Reads an index. Checks its range only if the counts before these lines are known.
int ObjLineReader::read_index(size_t ObjCounts::*kind, const char* what) {
  int index = 0;
  if (!lines_.integer(index)) lines_.fail(std::string("expected the index of a ") + what);
  if (before_ != nullptr) {
    const size_t count = before_->*kind + counts_now().*kind;
    uint32_t found = 0;
    const bool may_dangle = kind != &ObjCounts::positions && count == 0;
    if (!may_dangle && !resolve_obj_index(index, count, found))
      lines_.fail(std::string("index ") + std::to_string(index) + " of a " + what +
                  " is out of range (" + std::to_string(count) + " so far)");
  }
  // not_given is reserved; the replacement is just as far out of range.
  return index == ObjWrittenCorner::not_given ? index + 1 : index;
}

// Reads v, v/vt, v//vn or v/vt/vn; false at the end of the line.
bool ObjLineReader::read_corner() {
  if (!lines_.has_word()) return false;
  ObjWrittenCorner corner;
  corner.position = read_index(&ObjCounts::positions, "vertex");
  if (lines_.peek() == '/') {
    lines_.take();
    if (lines_.peek() != '/') corner.uv = read_index(&ObjCounts::uvs, "texture coordinate");
    if (lines_.peek() == '/') {
      lines_.take();
      corner.normal = read_index(&ObjCounts::normals, "normal");
    }
  }
  const char c = lines_.peek();
  if (c != '\0' && c != ' ' && c != '\t') lines_.fail("malformed corner of a face");
  piece_.written.push_back(corner);
  return true;
}

void ObjLineReader::read_face() {
  const size_t first = piece_.written.size();
  while (read_corner()) {
  }
  const size_t size = piece_.written.size() - first;
  if (size == 0) lines_.fail("a face without vertices");
  if (size >= 3) triangles_ += size - 2;
  if ((before_ != nullptr ? before_->triangles : 0) + triangles_ > max_scene_triangles)
    lines_.fail("more than " + std::to_string(max_scene_triangles / 1'000'000) +
                " million triangles");
  const ObjCounts now = counts_now();
  const ObjCounts last = piece_.seen.empty() ? ObjCounts() : piece_.seen.back().counts;
  if (now.positions != last.positions || now.uvs != last.uvs || now.normals != last.normals)
    piece_.seen.push_back({piece_.sizes.size(), {now.positions, now.uvs, now.normals}});
  piece_.sizes.push_back(uint32_t(size));
}

}  // namespace

bool read_obj_lines(const std::string& file, std::string_view text, bool is_first,
                    ObjPiece& piece) {
  try {
    ObjLineReader(file, text, is_first, nullptr, piece).read();
  } catch (const InputError&) {
    return false;
  }
  return true;
}

void read_obj_lines_after(const ObjCounts& before, const std::string& file, std::string_view text,
                          ObjPiece& piece) {
  ObjLineReader(file, text, before.lines == 0, &before, piece).read();
}

}  // namespace troffer
