// Position of a value in a JSON text, for error messages. The text is scanned again only when an
// error occurs.
// References: [1] RFC 6901, JSON Pointer; [2] RFC 8259, JSON.
#pragma once

#include <cstddef>
#include <string_view>

namespace troffer {

// Line and column, from 1; columns count bytes.
struct TextPosition {
  int line = 1, column = 1;
};

// Returns the position of the byte at `offset`; of the end of the text if that is less.
TextPosition position_of_offset(std::string_view text, size_t offset);

// Returns the position of the value that `pointer` ("/accessors/3/count" [1]) names in well-formed
// JSON. If a member is missing, returns the position of the innermost existing value on the path.
// Among equal keys the last counts, as for parsers.
TextPosition position_of_json_value(std::string_view text, std::string_view pointer);

}  // namespace troffer
