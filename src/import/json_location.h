// Where a value of a JSON text stands, found by scanning the text again when an error needs it.
// References: [1] RFC 6901, JSON Pointer; [2] RFC 8259, JSON.
#pragma once

#include <cstddef>
#include <string_view>

namespace troffer {

// Line and column from 1; columns count bytes.
struct TextPosition {
  int line = 1, column = 1;
};

// Position of the byte at `offset` (the end of the text for larger ones).
TextPosition position_of_offset(std::string_view text, size_t offset);

// Position of the value that `pointer` ("/accessors/3/count" [1]) names in a well-formed JSON text.
// Where a member is not there, the position of the innermost value on the way that is; of equal
// keys the last counts, as it does for parsers.
TextPosition position_of_json_value(std::string_view text, std::string_view pointer);

}  // namespace troffer
