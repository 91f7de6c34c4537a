// Scalars in the body of a PLY file, one after the other, in any of the three encodings. ply.cpp
// and ply_attributes.cpp read rows through it. Errors are InputError; they have a line and column
// only in ascii bodies.
#pragma once

#include <string>
#include <string_view>

#include "import/mesh/ply_header.h"

namespace troffer {

// A cursor over the scalars of a body.
class PlyBody {
 public:
  // Starts at byte `begin`, which is on line `line`. The text must outlive this object.
  PlyBody(std::string_view text, size_t begin, int line, PlyFormat format, const std::string& file)
      : text_(text), at_(begin), line_start_(begin), line_(line), format_(format), file_(file) {}

  double next(PlyType type) {
    return format_ == PlyFormat::ascii ? next_ascii(type) : next_binary(type);
  }
  size_t at() const { return at_; }
  size_t remaining() const { return text_.size() - at_; }
  bool is_ascii() const { return format_ == PlyFormat::ascii; }
  // Moves to the next scalar of an ascii body; true if there is none.
  bool is_done();
  // Moves to byte `at`, which lies `lines` line ends ahead.
  void go_to(size_t at, int lines) {
    at_ = line_start_ = at;
    line_ += lines;
  }
  // Moves to just after the last scalar before byte `end`. There are `lines` line ends up to `end`.
  void go_past_last_scalar(size_t end, int lines);
  // Reads the length of a list. Throws InputError if it is negative or the text is too short for
  // it.
  size_t list_length(const PlyProperty& property);
  void skip(const PlyProperty& property);
  // Throws InputError at the scalar read last.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  std::string_view text_;
  size_t at_, last_ = 0, line_start_;
  int line_;
  PlyFormat format_;
  const std::string& file_;

  void skip_blanks();
  double next_ascii(PlyType type);
  double next_binary(PlyType type);
};

}  // namespace troffer
