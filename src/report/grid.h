// Grids of measuring points after EN 12464-1, 4.4.
// Reference: [1] EN 12464-1, "Light and lighting – Lighting of work places – Part 1: Indoor work
//   places", 4.4 "Illuminance grid".
#pragma once

namespace troffer {

struct GridShape {
  int columns = 1, rows = 1;
};

// The largest side of a cell, m, for an area whose reference dimension is d metres: p = 0.2 ·
// 5^(log10 d), and never more than 10 m [1].
double largest_cell(double d);

// Cells of an area of width × height metres, both above 0. d is the longer side, or the shorter one
// where the longer is twice as long or more. Along d there are as few cells as p allows, and along
// the other side as few as are no longer than those [1]. Sides of a cell have a ratio between .5
// and 2.
GridShape grid_shape(double width, double height);

// Cells whose sides are at most `spacing` metres long, as few as can be.
GridShape grid_of_spacing(double width, double height, double spacing);

// Of a room: how far off the walls points are measured, m: .5, or .15 of the shorter side where
// that is less [1].
double border_zone(double width, double height);

}  // namespace troffer
