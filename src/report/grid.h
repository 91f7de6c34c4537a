// Chooses grids of measuring points by EN 12464-1, 4.4. Lengths are in metres.
// Surfaces of reports and measuring grids use it.
// Reference: [1] EN 12464-1, "Light and lighting – Lighting of work places – Part 1: Indoor work
// places", 4.4 "Illuminance grid".
#pragma once

namespace troffer {

// Number of cells along width and height.
struct GridShape {
  int columns = 1, rows = 1;
};

// Returns the largest side of a cell, m, for an area whose reference dimension is d metres: p = 0.2
// · 5^(log10 d), at most 10 m [1].
double largest_cell(double d);

// Returns the cells of an area of width × height metres, both above 0. The reference dimension d is
// the longer side, or the shorter one if the longer is at least twice as long. Along d there are as
// few cells as largest_cell() allows; along the other side as few as are no longer than those [1].
// The sides of a cell have a ratio between .5 and 2.
GridShape grid_shape(double width, double height);

// Returns the fewest cells whose sides are at most `spacing` metres long.
GridShape grid_of_spacing(double width, double height, double spacing);

// Returns the width of the zone along a room's walls that has no measuring points, m: .5, or .15 of
// the shorter side if that is less [1].
double border_zone(double width, double height);

}  // namespace troffer
