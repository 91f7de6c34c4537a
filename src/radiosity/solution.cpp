#include "radiosity/solution.h"

#include <algorithm>

namespace troffer {

size_t RadiositySolution::memory_bytes() const {
  return mesh.memory_bytes() +
         (general.capacity() + general_direct.capacity() + shot_radiance.capacity()) * sizeof(Rgb) +
         stored.capacity() * sizeof(StoredContribution);
}

Rgb interpolated_irradiance(const RadiositySolution& solution, const Interpolation& at) {
  Rgb sum;
  for (const PointWeight& w : at.weights()) sum += solution.irradiance(w.point) * w.weight;
  return sum;
}

}  // namespace troffer
