// Describes a scene as seen from straight above: axes, north, and reading order of a plan.
// Plans use it, and the searches for floors and desks that number names.
#pragma once

#include <string_view>
#include <vector>

#include "report/surface.h"

namespace troffer {

// Axes of a plan, unit length: to the right and to the top. The right is the world's x, projected
// onto the level plane (y if the vertical is along x).
struct PlanAxes {
  Vec3d right, top;
  Vec2d of(const Vec3d& p) const { return {dot(p, right), dot(p, top)}; }
};
PlanAxes plan_axes(const Vec3d& up);

// Returns the direction of north: `north_deg` clockwise from -z, or from +y if z is up, as --north
// counts. Counterclockwise if the world is mirrored.
Vec3d north_of(const Vec3d& up, double north_deg, bool is_mirrored);

// Sorts surfaces in the order in which a plan is read: rows from the top, each from the left. A new
// row starts where the next surface lies more than half a metre lower.
void sort_by_rows(std::vector<AssessedSurface*>& surfaces, const Vec3d& up);

// True if name a comes before b. Digits compare as numbers, so "desk 2" comes before "desk 10".
bool natural_less(std::string_view a, std::string_view b);

}  // namespace troffer
