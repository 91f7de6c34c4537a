// Lines of an OBJ file -> the statements that they hold.
#pragma once

#include <string>
#include <string_view>

#include "import/mesh/obj_piece.h"

namespace troffer {

// Lines of a file, the first ones (is_first) or further ones; false where something is wrong with
// them in themselves.
bool read_obj_lines(const std::string& file, std::string_view text, bool is_first, ObjPiece& piece);

// The same of lines that come after `before`. InputError: what is wrong first, indices that are out
// of range and triangles that are too many included; all before it is in the piece.
void read_obj_lines_after(const ObjCounts& before, const std::string& file, std::string_view text,
                          ObjPiece& piece);

}  // namespace troffer
