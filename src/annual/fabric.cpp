#include "annual/fabric.h"

#include <fmt/format.h>

#include <algorithm>

namespace troffer {

std::string fault_of(const Fabric& f) {
  for (const double share : {f.openness, f.transmittance, f.reflectance})
    if (!(share >= 0 && share <= 1)) return "has a value that is not from 0 to 1";
  if (f.openness >= 1) return "is all holes: its openness is 1";
  if (f.openness > f.transmittance)
    return fmt::format("has an openness of {} above its transmittance of {}, which includes it",
                       f.openness, f.transmittance);
  if (f.transmittance + f.reflectance > 1) return "passes and reflects more light than it gets";
  return {};
}

Material material_of(const Fabric& f) {
  const double covered = 1 - f.openness;
  const auto of_threads = [&](double share) { return float(std::min(1.0, share / covered)); };
  Material m;
  m.name = f.name;
  m.kind = MaterialKind::diffuse;
  m.base_color.value = Rgb{of_threads(f.reflectance)};
  m.diffuse_transmission.value = of_threads(f.transmittance - f.openness);
  if (f.openness > 0) {
    m.is_alpha_masked = true;
    m.is_alpha_blended = true;
    m.alpha.value = float(covered);
  }
  return m;
}

}  // namespace troffer
