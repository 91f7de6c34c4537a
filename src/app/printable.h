// Makes text from files safe to print on a terminal.
#pragma once

#include <string>

namespace troffer {

// Replaces each control character (C0, DEL, and C1 in UTF-8) by a question mark, because a terminal
// would obey it.
inline std::string printable(std::string text) {
  std::string out;
  for (size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    const auto next = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1]) : 0u;
    const bool is_c1 = c == 0xc2 && next >= 0x80 && next < 0xa0;
    out += c < 0x20 || c == 0x7f || is_c1 ? '?' : text[i];
    if (is_c1) ++i;
  }
  return out;
}

}  // namespace troffer
