// Rooms with one opening, and their daylight by quadrature in double precision, for the daylight
// cases of CIE 171.
// It uses none of the program's own code for skies, glass or visibility. Lengths are in metres,
// light in lx and cd/m².
// References: [1] CIE 171:2006, "Test cases to assess the accuracy of lighting computer programs".
// References: [1] CIE 171:2006, "Test cases to assess the accuracy of lighting computer programs".
//   [2] CIE S 011/E:2003 (ISO 15469:2004), "Spatial distribution of daylight: CIE standard general
//   sky", table 1.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/vec.h"

namespace troffer::test {

struct Point {
  Vec3d position, normal;
};

// A rectangle; z is up, y is north.
struct Rectangle {
  Vec3d corner, along, across;  // orthogonal sides
};

// Returns a pbrt file of rectangles with one reflectance.
std::string pbrt_rectangles(const std::vector<Rectangle>& rectangles, double reflectance);

// Returns a pbrt file of panes of clear glass with index 1.5.
std::string pbrt_glass(const std::vector<Rectangle>& rectangles);

// A black room of 4 × 4 × 3 m around (0, 0, 1.5), with a hole in the ceiling or in the south wall.
// The middle of the hole lies at x = 0.
struct Room {
  bool has_roof_opening = true;
  double width = 1, height = 1;  // size of the opening (in the ceiling: height is from south to
                                 // north)
  double sill = 0;               // height of an opening in the wall above the floor

  std::vector<Rectangle> walls() const;
  Rectangle opening() const;
};

// Luminance by direction, cd/m².
using Luminance = std::function<double(const Vec3d& towards)>;

// Returns a CIE general sky with 10 000 lx on a horizontal plane. The sun stands in the south, 60°
// high, and emits nothing. Below the horizon lies a ground with the given reflectance.
Luminance cie_sky_of(int type, double ground_reflectance);

// Returns the illuminance at a point through an opening: the integral of luminance(p, towards) ×
// cosines / distance² over the opening. cuts: heights above the floor at which the luminance seen
// from p has a kink (openings in a wall).
double illuminance_through(const Rectangle& opening, const Point& p,
                           const std::function<double(const Vec3d& from, const Vec3d& towards)>&,
                           std::vector<double> cuts = {});

// Returns the same for uniform luminance in closed form (Lambert), exact at any distance and size.
double illuminance_of(const Rectangle& even, const Point& p, double luminance);

// Returns the transmittance of a pane of index 1.5 without absorption, by the cosine of incidence:
// Fresnel's equations at both faces, both polarisations, all internal reflections.
double pane_transmittance(double cosine);

}  // namespace troffer::test
