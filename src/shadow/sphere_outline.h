// Spheres: seen from a point outside, a sphere of uniform radiance is the disk that its outline
// spans, and what hides the one hides the other. Each receiver has its own disk; lists of facets
// are shared by a cluster.
// References: docs/certified.md, "Spheres".
#pragma once

#include "base/quad.h"
#include "base/round_body.h"
#include "shadow/shadow_source.h"
#include "shadow/shaft.h"

namespace troffer {

// Whether receivers may touch the sphere, or nearly so: there is no shaft to it.
bool is_near(const SphereSource& sphere, const ReceiverHull& hull);

// The disk that the sphere's outline spans from x, as its bounding square.
Parallelogram outline_of(const SphereSource& sphere, const Vec3d& x);

// Whether a facet may reach into the sphere, where it would hide the disk but not the cap.
bool may_enter(const Quad& facet, const SphereSource& sphere);
// Whether all of it lies within the sphere, where it hides nothing.
bool is_within(const Quad& facet, const SphereSource& sphere);
bool is_within(const RoundBody& body, const SphereSource& sphere);

}  // namespace troffer
