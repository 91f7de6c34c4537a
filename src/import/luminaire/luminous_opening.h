// The luminous opening of a measured luminaire: what its file says of it, and the body that is.
//
// References: [1] ANSI/IESNA LM-63-02, Table 1, and LM-63-95: luminous shapes by the signs of
// width,
//   length and height. [2] Stockmar, "EULUMDAT", Licht '90: lengths, widths and luminous heights.
#pragma once

#include <array>
#include <vector>

#include "base/vec.h"
#include "scene/light_web.h"

namespace troffer {

// Extents along the luminaire's own axes (LightWeb), m. Those that are round span an ellipse with
// another one that is, or with both others an ellipsoid.
struct LuminousOpening {
  Vec3d size;
  std::array<bool, 3> is_round{};
  // Of a box: how far up its sides shine, from the nadir's end; towards C0, C90, C180 and C270.
  std::array<double, 4> sides{};
};

// By LM-63's signs [1]; before 2002 one negative dimension was enough for a circle, a cylinder, a
// sphere or an ellipsoid, and a lying cylinder's only one was its diameter, the height. Its length
// lies in the plane C0, its width in C90.
LuminousOpening ies_opening(double width, double length, double height, bool is_before_2002);

// EULUMDAT: no width, a circle [2]. Its length lies in the plane C90; `sides` as above.
LuminousOpening eulumdat_opening(double length, double width, const std::array<double, 4>& sides);

struct OpeningFace {
  std::vector<Vec3d> outline;  // convex, from the body's middle, in the luminaire's axes
  Vec3d area;                  // outward normal times area, m²
};

// A body that shines: a sphere, a disc that faces the nadir, or convex flat faces, one of them
// where it is flat (and may shine to both sides).
struct OpeningBody {
  enum class Shape { point, sphere, disc, faces };
  Shape shape = Shape::point;
  double radius = 0;  // sphere, disc
  std::vector<OpeningFace> faces;
};

// Ellipses become polygons of as many corners as a circle has here, of the same area; ellipsoids
// spheres of the same volume; what has one extent alone a point.
constexpr int circle_corners = 24;
OpeningBody body_of(const LuminousOpening& opening);

// Light leaves through a face of this normal, in the luminaire's axes: more than a thousandth of
// the largest intensity goes there. Files go on to the zenith whether or not light does.
bool shines_towards(const LightWeb& web, const Vec3d& normal);

}  // namespace troffer
