// What shoots and what receives in the radiosity preprocessing.
//
// The surfaces of a scene are cut into *sheets*, a sheet into *elements*. Diffuse surfaces reflect
// alike on both sides, so each side of a sheet that light can reach is a *patch* of its own, which
// shoots, and each side of an element has a *sample point* of its own, which receives. Sides that
// no light can reach (the inside of closed solids, the outside of a room) have neither.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/rgb.h"
#include "base/vec.h"

namespace troffer {

constexpr uint32_t no_point = 0xffffffffu;
constexpr uint32_t no_fragment = 0xffffffffu;

// A sample point: where irradiance is received and stored. It stands for one side of an element.
struct ElementPoint {
  Vec3 position;        // on the surface, amid the element
  Vec3 normal;          // unit, on the side that receives
  float area = 0;       // m² of the element, without its alpha-masked holes
  float offset = 0;     // metres by which rays start off the surface
  Rgb reflectance;      // of the element's diffuse part, hemispherical, textures averaged
  Rgb specular_albedo;  // what it scatters otherwise: does not shoot, is counted as lost
  uint32_t patch = 0;
};

// One side of a sheet. Its sample points are [first_point, last_point).
struct Patch {
  uint32_t sheet = 0;
  uint32_t first_point = 0, last_point = 0;
  bool is_back = false;
  float area = 0;  // m², the sum over its points
  // Of `open_rays` rays from its points, spread by the cosine: the share that leaves the scene.
  float open = 0;
  uint32_t open_rays = 0;
};

// Pieces [first_piece, last_piece) are convex polygons that together are the sheet.
struct Sheet {
  uint32_t first_piece = 0, last_piece = 0;
  Vec3 round_centre;       // of the sphere that the sheet is part of …
  float round_radius = 0;  // … or 0: rays end on the pieces themselves
  float offset = 0;        // metres, as of points
};

// Part of a triangle that lies in one element; corners run as the triangle's do.
struct Fragment {
  std::array<uint32_t, 3> vertices{};
  uint32_t element = 0;
};

// Half of a triangle after half, by cutting `edge` (between corners edge and edge + 1) in the
// middle. A child is a node, or ~fragment where negative; the first one keeps corner `edge`.
struct SplitNode {
  std::array<int32_t, 2> child{};
  uint8_t edge = 0;
};

}  // namespace troffer
