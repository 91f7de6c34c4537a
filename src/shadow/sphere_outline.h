// Spherical sources. From a point outside, a sphere of uniform radiance looks like the disk that
// its outline spans, and the same occluders hide both. Each receiver has its own disk; facet lists
// are shared by the cluster. settle_part.cpp and gather_facets.cpp use this.
// References: docs/method/certified-appendix.md, "Spheres".
#pragma once

#include "base/quad.h"
#include "base/round_body.h"
#include "shadow/shadow_source.h"
#include "shadow/shaft.h"

namespace troffer {

// True if receivers may touch the sphere, or nearly so. No shaft to it exists then.
bool is_near(const SphereSource& sphere, const ReceiverHull& hull);

// Returns the disk that the sphere's outline spans from x, as its bounding square.
Parallelogram outline_of(const SphereSource& sphere, const Vec3d& x);

// True if a facet may reach into the sphere, where it would hide the disk but not the visible cap.
bool may_enter(const Quad& facet, const SphereSource& sphere);
// True if all of it lies within the sphere, where it hides nothing.
bool is_within(const Quad& facet, const SphereSource& sphere);
bool is_within(const RoundBody& body, const SphereSource& sphere);

}  // namespace troffer
