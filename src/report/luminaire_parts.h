// Luminaires of a scene: what shines under one name and hangs together.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "report/groups.h"
#include "transport/prepared_scene.h"

namespace troffer {

using LightPieces = std::vector<uint32_t>;  // numbers of light primitives

// Per name, its luminaires: lamps of one name may hang far from each other, and faces of one lamp,
// which share corners (to a tenth of a millimetre), are one. Daylight is left out.
std::map<std::string, std::vector<LightPieces>> luminaire_parts(const PreparedScene& scene);

// Intensities in the planes C0 to C180 and C90 to C270, cd, every 5 degrees from -180 to 180;
// 0 is the aim.
struct PolarCurve {
  static constexpr int steps = 73;
  std::array<std::array<double, steps>, 2> candela{};
  double largest() const;
};

struct PlacedLuminaire {
  std::string name;
  std::string product;          // of its photometric file, or what kind of light it is
  Vec3d position;               // middle, in the file's coordinates, m
  Vec3d aim;                    // unit; zero: it shines all around
  double lumens = 0;            // initial
  std::optional<double> watts;  // none: unknown
  PolarCurve curve;
};

// All luminaires, in natural order of names. products: by photometric file, what it says of itself.
std::vector<PlacedLuminaire> placed_luminaires(const PreparedScene& scene,
                                               const std::vector<PowerRequest>& power,
                                               const std::map<std::string, std::string>& products);

}  // namespace troffer
