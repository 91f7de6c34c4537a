// A scene seen from straight above, as plans show it.
#pragma once

#include <string_view>
#include <vector>

#include "report/surface.h"

namespace troffer {

// Directions of a plan: to the right and to its top; unit. The right is the world's x as far as the
// vertical allows.
struct PlanAxes {
  Vec3d right, top;
  Vec2d of(const Vec3d& p) const { return {dot(p, right), dot(p, top)}; }
};
PlanAxes plan_axes(const Vec3d& up);

// North on a plan: `north_deg` clockwise from -z, or from +y where z is up, as --north counts; the
// other way round where the world is mirrored.
Vec3d north_of(const Vec3d& up, double north_deg, bool is_mirrored);

// Order in which a plan is read: row by row from its top, each from the left. A row ends where the
// next surface lies more than half a metre lower.
void sort_by_rows(std::vector<AssessedSurface*>& surfaces, const Vec3d& up);

// Whether a name comes before another: digits in it count as numbers, so that "desk 2" comes before
// "desk 10".
bool natural_less(std::string_view a, std::string_view b);

}  // namespace troffer
