#include "radiosity/solution.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace troffer {

size_t RadiositySolution::memory_bytes() const {
  return mesh.memory_bytes() +
         (general.capacity() + general_direct.capacity() + shot_radiance.capacity()) * sizeof(Rgb) +
         stored.capacity() * sizeof(StoredContribution);
}

std::vector<std::string> radiosity_warnings(const RadiositySolution& s) {
  constexpr double allowed = 0.01;  // of the emitted power
  const EnergyBalance& b = s.balance;
  std::vector<std::string> out;
  const auto percent = [&](double part) { return 100 * part / b.emitted; };
  if (b.emitted > 0 && !(std::abs(b.unaccounted) <= allowed * b.emitted))
    out.push_back(fmt::format(
        "radiosity: {:.1f} % of the emitted power came to no sample point and did not leave the "
        "scene (absorbed {:.1f} %, specular {:.1f} %, escaped {:.1f} %, not shot {:.1f} %): "
        "elements of {:.3g} m are too coarse for this scene; --element-size makes them smaller",
        percent(b.unaccounted), percent(b.absorbed), percent(b.lost_to_specular),
        percent(b.escaped), percent(b.unshot), s.mesh.element_size));
  if (s.end == RadiosityEnd::out_of_shots || s.end == RadiosityEnd::out_of_rays)
    out.push_back(
        fmt::format("radiosity: ended after {} shots and {:.0f} million rays with {:.1f} % of the "
                    "emitted power "
                    "unshot; that much is spread evenly as an estimate",
                    s.shots, double(s.rays) * 1e-6, b.emitted > 0 ? percent(b.unshot) : 0.0));
  return out;
}

Rgb interpolated_irradiance(const RadiositySolution& solution, const Interpolation& at) {
  Rgb sum;
  for (const PointWeight& w : at.weights()) sum += solution.irradiance(w.point) * w.weight;
  return sum;
}

}  // namespace troffer
