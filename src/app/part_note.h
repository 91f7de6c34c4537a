// What a picture file of one share says of itself, so that shares can be joined to the right whole.
#pragma once

#include <array>
#include <string>

#include "render/checkpoint.h"
#include "render/picture_key.h"

namespace troffer {

struct PartNote {
  PictureShare share;
  bool is_complete = false;
  std::array<int, 4> asked{};  // pixels of all shares together: x0, y0, x1, y1, exclusive
  int width = 0, height = 0;   // of the whole image
  bool has_crop = false;       // asked for by a crop
  PictureKey key;
  bool operator==(const PartNote&) const = default;
};

// One line of text.
std::string text_of(const PartNote& note);
// Throws InputError, naming `file`, where this is no such text.
PartNote parse_part_note(const std::string& text, const std::string& file);

}  // namespace troffer
