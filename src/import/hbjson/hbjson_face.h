// Flat faces of Honeybee models, and faces with openings as convex pieces. Used by the importer of
// HBJSON. Lengths are in metres.
#pragma once

#include <vector>

#include "base/vec.h"
#include "import/gltf/gltf_json.h"

namespace troffer {

using Corners = std::vector<Vec3d>;

struct HbjsonFace {
  Corners boundary;
  std::vector<Corners> holes;
};

// Reads a Face3D. unit_m: length of a unit of the file, metres.
HbjsonFace read_hbjson_face(const JsonNode& geometry, double unit_m);
// Reads an array of points, each an array of three numbers, with at least `least` points.
Corners read_hbjson_points(const JsonNode& list, double unit_m, size_t least);

// Returns the unit normal of a polygon by Newell's method; zero if it has no area.
Vec3d normal_of(const Corners& polygon);

// Returns convex polygons that cover the boundary without the openings, wound as the boundary.
// Openings are projected onto its plane. They may touch or overlap each other and the boundary.
std::vector<Corners> without_openings(const Corners& boundary,
                                      const std::vector<Corners>& openings);

}  // namespace troffer
