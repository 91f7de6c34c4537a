// Wildcards in names that options give: 'panel*' fits panel.001 and panel.002. Used wherever an
// option names lights, surfaces or nodes.
#pragma once

#include <string_view>

namespace troffer {

// True if `pattern` equals the name, or fits it with '*' for any letters or none.
inline bool fits_wildcard(std::string_view name, std::string_view pattern) {
  if (name == pattern) return true;
  size_t n = 0, p = 0, star = pattern.npos, after_star = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      after_star = n;
    } else if (p < pattern.size() && pattern[p] == name[n]) {
      ++p;
      ++n;
    } else if (star != pattern.npos) {
      p = star + 1;
      n = ++after_star;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

}  // namespace troffer
