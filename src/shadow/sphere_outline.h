// Spheres: seen from a point outside, a sphere of uniform radiance is the disk that its outline
// spans, and what hides the one hides the other. Each receiver has its own disk; lists of facets
// are shared by a cluster.
// References: docs/certified.md, "Spheres".
#pragma once

#include <array>

#include "base/quad.h"
#include "shadow/shadow_source.h"
#include "shadow/shaft.h"

namespace troffer {

// A square about the sphere's centre, across the line from the receivers, in which or before which
// every segment from them to the visible cap ends. is_near: the sphere is too near, there is no
// such square, or one much larger than the sphere.
struct SphereSquare {
  std::array<Vec3d, 4> corners;
  Vec3d normal;  // towards the receivers
  bool is_near = false;
};
SphereSquare square_about(const SphereSource& sphere, const ReceiverHull& hull);

// The disk that the sphere's outline spans from x, as its bounding square.
Parallelogram outline_of(const SphereSource& sphere, const Vec3d& x);

// Whether a facet may reach into the sphere, where it would hide the disk but not the cap.
bool may_enter(const Quad& facet, const SphereSource& sphere);

}  // namespace troffer
