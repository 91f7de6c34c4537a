// Test of whether environment light reaches the surfaces that a scene's other lights shine on.
// CertifiedLights uses it to recognize rooms that are closed, where certificates of sky patches
// would be wasted.
#pragma once

#include "certified/environment_sampler.h"
#include "trace/closed_shells.h"
#include "transport/prepared_scene.h"

namespace troffer {

// Returns true if none of thousands of rays towards `points` arrives. The rays leave surfaces that
// the scene's own lights reach directly or by up to three reflections; walks that start inside
// `shells` are left out. This is evidence, not proof, and decides only where to spend less effort.
// Returns false at the first ray that arrives, or if the scene has no lights of its own.
// Deterministic.
bool are_lit_surfaces_closed(const PreparedScene& scene, const EnvironmentSampler& points,
                             const ClosedShells& shells);

}  // namespace troffer
