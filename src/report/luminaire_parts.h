// Finds the luminaires of a scene: connected parts of lights of one name.
// Glare, the luminaire list and polar plots of reports use it. Positions are in the file's
// coordinates, intensities in cd.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "report/groups.h"
#include "transport/prepared_scene.h"

namespace troffer {

using LightPieces = std::vector<uint32_t>;  // indices of light primitives

// Returns the luminaires of each name. Lamps of one name that lie apart are separate luminaires.
// Faces that share corners (to a tenth of a millimetre) belong to one luminaire. Daylight is left
// out.
std::map<std::string, std::vector<LightPieces>> luminaire_parts(const PreparedScene& scene);

// Intensities in the planes C0-C180 and C90-C270, cd, every 5 degrees from -180 to 180; 0 is the
// direction of the aim.
struct PolarCurve {
  static constexpr int steps = 73;
  std::array<std::array<double, steps>, 2> candela{};
  double largest() const;
};

// A luminaire with its position and photometry.
struct PlacedLuminaire {
  std::string name;
  std::string product;          // product by its photometric file, or the kind of light
  Vec3d position;               // middle, in the file's coordinates, m
  Vec3d aim;                    // unit; zero: no main direction
  double lumens = 0;            // initial flux, lm
  std::optional<double> watts;  // power, W; empty if unknown
  PolarCurve curve;
};

// Returns all luminaires, in natural order of names. products: description by photometric file.
std::vector<PlacedLuminaire> placed_luminaires(const PreparedScene& scene,
                                               const std::vector<PowerRequest>& power,
                                               const std::map<std::string, std::string>& products);

}  // namespace troffer
