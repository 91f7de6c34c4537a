// Rooms with one opening, and how much light comes in, by quadrature in double precision: what the
// cases of CIE 171 about daylight are made of. Written without any of the program's own code for
// skies, glass or visibility.
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

// z is up, y is north.
struct Rectangle {
  Vec3d corner, along, across;  // the sides are orthogonal
};

// A pbrt file of rectangles that reflect the same share.
std::string pbrt_rectangles(const std::vector<Rectangle>& rectangles, double reflectance);

// … of panes of clear glass of index 1.5.
std::string pbrt_glass(const std::vector<Rectangle>& rectangles);

// The walls of a room of 4 × 4 × 3 m about (0, 0, 1.5), black, with a hole in the ceiling or in the
// south wall, whose middle lies at x = 0.
struct Room {
  bool has_roof_opening = true;
  double width = 1, height = 1;  // of the opening (in the ceiling: from south to north)
  double sill = 0;               // height above the floor, in the wall

  std::vector<Rectangle> walls() const;
  Rectangle opening() const;
};

// Luminance by direction, cd/m².
using Luminance = std::function<double(const Vec3d& towards)>;

// A CIE general sky of 10 000 lx on a horizontal plane, the sun in the south 60° high, which itself
// sends nothing; below the horizon a ground that reflects so much of it.
Luminance cie_sky_of(int type, double ground_reflectance);

// What arrives at a point through an opening: the integral of luminance(p, towards) × cosines /
// distance² over the opening, which is cut where p sees a kink of the luminance: at these heights
// above the floor (of openings in a wall).
double illuminance_through(const Rectangle& opening, const Point& p,
                           const std::function<double(const Vec3d& from, const Vec3d& towards)>&,
                           std::vector<double> cuts = {});

// The same of an even luminance, in closed form (Lambert): exact however near or large it is.
double illuminance_of(const Rectangle& even, const Point& p, double luminance);

// The share of its light that a pane of index 1.5 without absorption lets through at a cosine of
// incidence: Fresnel's equations at both of its faces, for each of the two polarisations, and all
// reflections between them.
double pane_transmittance(double cosine);

}  // namespace troffer::test
