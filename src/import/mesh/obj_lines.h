// Parser of OBJ lines into an ObjPiece. obj.cpp first parses many pieces in parallel with
// read_obj_lines. If one is malformed, it parses that piece again with read_obj_lines_after, which
// knows the counts before it and reports the error.
#pragma once

#include <string>
#include <string_view>

#include "import/mesh/obj_piece.h"

namespace troffer {

// Parses lines of a file; `is_first` for the first ones. Returns false if a line is malformed in
// itself. Indices are not checked.
bool read_obj_lines(const std::string& file, std::string_view text, bool is_first, ObjPiece& piece);

// Parses lines that follow `before`. Throws InputError at the first error, including indices out of
// range and too many triangles. `piece` then holds everything before the error.
void read_obj_lines_after(const ObjCounts& before, const std::string& file, std::string_view text,
                          ObjPiece& piece);

}  // namespace troffer
