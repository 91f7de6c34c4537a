#include "import/two_widths.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace troffer {

namespace {

float width_of(float roughness, RoughnessMeaning meaning) {
  const float r = std::clamp(roughness, 0.0f, 1.0f);
  return meaning == RoughnessMeaning::alpha           ? r
         : meaning == RoughnessMeaning::alpha_is_sqrt ? std::sqrt(r)
                                                      : r * r;
}

}  // namespace

// The narrower width is the roughness; the wider one alpha + (1 - alpha) × anisotropy².
void set_two_widths(Material& m, float along_u, float along_v) {
  const float narrow = std::min(along_u, along_v), wide = std::max(along_u, along_v);
  m.roughness = {narrow, no_texture, m.roughness.channel};
  const float a = width_of(narrow, m.roughness_meaning), b = width_of(wide, m.roughness_meaning);
  if (!(b > a)) return;
  m.anisotropy.value = std::sqrt((b - a) / (1 - a));
  m.anisotropy_rotation_rad = along_v > along_u ? 0.5f * pi_f : 0;
}

}  // namespace troffer
