// Shooters and receivers of the radiosity solution.
//
// The surfaces of a scene are cut into *sheets*, and sheets into *elements*. Diffuse surfaces
// reflect alike on both sides. Each side of a sheet that light can reach is therefore a separate
// *patch*, which shoots. Each side of an element has a separate *sample point*, which receives.
// Sides that light cannot reach (the inside of closed solids, the outside of a room) have neither.
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

// Sample point: it receives and stores irradiance for one side of an element.
struct ElementPoint {
  Vec3 position;        // on the surface, near the element's centroid
  Vec3 normal;          // unit, on the receiving side
  float area = 0;       // m² of the element, without its alpha-masked holes
  float offset = 0;     // metres; ray origins start this far off the surface
  Rgb reflectance;      // hemispherical, of the diffuse part; textures averaged
  Rgb specular_albedo;  // albedo of the other lobes: not shot, counted as lost
  uint32_t patch = 0;
};

// One side of a sheet. Its sample points are [first_point, last_point).
struct Patch {
  uint32_t sheet = 0;
  uint32_t first_point = 0, last_point = 0;
  bool is_back = false;
  float area = 0;  // m², sum over its points
  // Share of rays that leave the scene; `open_rays` cosine-distributed rays start at its points.
  float open = 0;
  uint32_t open_rays = 0;
};

// The convex polygons [first_piece, last_piece) together form the sheet.
struct Sheet {
  uint32_t first_piece = 0, last_piece = 0;
  Vec3 round_centre;       // centre of the sphere that the sheet is part of
  float round_radius = 0;  // 0: flat; rays end on the pieces themselves
  float offset = 0;        // metres, as ElementPoint::offset
};

// Part of a triangle that lies in one element; its corners have the triangle's orientation.
struct Fragment {
  std::array<uint32_t, 3> vertices{};
  uint32_t element = 0;
};

// Node of a triangle bisection: `edge` (between corners edge and edge + 1) is cut in the middle. A
// child is a node, or ~fragment if negative. The first child keeps corner `edge`.
struct SplitNode {
  std::array<int32_t, 2> child{};
  uint8_t edge = 0;
};

}  // namespace troffer
