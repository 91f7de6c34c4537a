#include "app/part_note.h"

#include <fmt/format.h>

#include <cinttypes>
#include <cstdio>

#include "base/error.h"

namespace troffer {

std::string text_of(const PartNote& n) {
  return fmt::format(
      "part {}/{} complete {} pixels {} {} {} {} of {} {} crop {} key {:016x} {:016x} {:016x} "
      "program {}",
      n.share.part, n.share.parts, int(n.is_complete), n.asked[0], n.asked[1], n.asked[2],
      n.asked[3], n.width, n.height, int(n.has_crop), n.key.settings, n.key.scene,
      n.key.preparation, n.key.program);
}

PartNote parse_part_note(const std::string& text, const std::string& file) {
  PartNote n;
  int is_complete = 0, has_crop = 0;
  char program[16] = {};
  const int count = std::sscanf(
      text.c_str(),
      "part %9d/%9d complete %1d pixels %9d %9d %9d %9d of %9d %9d crop %1d key %16" SCNx64
      " %16" SCNx64 " %16" SCNx64 " program %15s",
      &n.share.part, &n.share.parts, &is_complete, &n.asked[0], &n.asked[1], &n.asked[2],
      &n.asked[3], &n.width, &n.height, &has_crop, &n.key.settings, &n.key.scene,
      &n.key.preparation, program);
  n.is_complete = is_complete == 1;
  n.has_crop = has_crop == 1;
  n.key.program = program;
  constexpr int all = 14;
  const bool is_sound = count == all && text_of(n) == text && n.share.part >= 1 &&
                        n.share.part <= n.share.parts && n.asked[0] >= 0 && n.asked[1] >= 0 &&
                        n.asked[0] < n.asked[2] && n.asked[1] < n.asked[3] &&
                        n.asked[2] <= n.width && n.asked[3] <= n.height;
  if (!is_sound) throw InputError(file, 0, 0, "its description of the part is damaged");
  return n;
}

}  // namespace troffer
