// The note in the picture file of one part, by which `troffer merge` joins parts of the same
// picture.
#pragma once

#include <array>
#include <string>

#include "render/checkpoint.h"
#include "render/picture_key.h"

namespace troffer {

// Contents of a note.
struct PartNote {
  PictureShare share;
  bool is_complete = false;
  std::array<int, 4> asked{};  // pixels of all parts together: x0, y0, x1, y1 (exclusive)
  int width = 0, height = 0;   // size of the whole image
  bool has_crop = false;       // the picture is a crop
  PictureKey key;
  bool operator==(const PartNote&) const = default;
};

// Formats a note as one line of text.
std::string text_of(const PartNote& note);
// Parses a note. Throws InputError with the name `file` if it is none.
PartNote parse_part_note(const std::string& text, const std::string& file);

}  // namespace troffer
