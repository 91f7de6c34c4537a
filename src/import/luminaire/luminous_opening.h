// The luminous opening of a luminaire: its dimensions in the photometric file, and the body they
// describe. The body's faces become the lights of a luminaire without geometry of its own
// (attach_luminaire.h). Lengths are in metres, in the luminaire's axes (LightWeb).
//
// References: [1] ANSI/IESNA LM-63-02, Table 1, and LM-63-95: luminous shapes by the signs of
//   width, length and height.
//   [2] Stockmar, "EULUMDAT", Licht '90: lengths, widths and luminous heights.
#pragma once

#include <array>
#include <vector>

#include "base/vec.h"
#include "scene/light_web.h"

namespace troffer {

// Extents along the luminaire's axes, m. Two round extents span an ellipse, three an ellipsoid.
struct LuminousOpening {
  Vec3d size;
  std::array<bool, 3> is_round{};
  // Luminous height of a box's sides from the nadir's end, m: towards C0, C90, C180 and C270.
  std::array<double, 4> sides{};
};

// Returns the opening by LM-63's signs [1]: a negative dimension is round. Length lies along C0,
// width along C90. Before 2002 one negative dimension sufficed for a circle, cylinder, sphere or
// ellipsoid, and a horizontal cylinder gave only its diameter, as the height.
LuminousOpening ies_opening(double width, double length, double height, bool is_before_2002);

// Returns the opening of EULUMDAT: a width of 0 means a circle [2]. Length lies along C90; `sides`
// as in LuminousOpening.
LuminousOpening eulumdat_opening(double length, double width, const std::array<double, 4>& sides);

// A convex flat face of a body.
struct OpeningFace {
  std::vector<Vec3d> outline;  // convex, relative to the body's centre, in the luminaire's axes
  Vec3d area;                  // outward normal times area, m²
};

// A luminous body: a point, a sphere, a disc that faces the nadir, or convex flat faces. A flat
// body has one face, which may shine to both sides.
struct OpeningBody {
  enum class Shape { point, sphere, disc, faces };
  Shape shape = Shape::point;
  double radius = 0;  // radius of a sphere or disc, m
  std::vector<OpeningFace> faces;
};

// Corners of the polygon of the same area that replaces an ellipse.
constexpr int circle_corners = 24;
// Returns the body of an opening. An ellipsoid becomes a sphere of the same volume. An opening with
// fewer than two extents becomes a point.
OpeningBody body_of(const LuminousOpening& opening);

// True if light leaves through a face with this normal (in the luminaire's axes): more than a
// thousandth of the largest intensity goes to that side. A table may list angles up to the zenith
// even where it is dark.
bool shines_towards(const LightWeb& web, const Vec3d& normal);

}  // namespace troffer
