// Whether light from infinity gets to where a scene's own lights shine.
#pragma once

#include "certified/far_points.h"
#include "trace/closed_shells.h"
#include "transport/prepared_scene.h"

namespace troffer {

// True: of thousands of rays towards `points`, from surfaces that the scene's lights shine on
// directly or by a few reflections, none arrives; what is inside `shells` is not asked for. Nothing
// is proved: it tells where to look less closely. False where one arrives, which is soon found, or
// where the scene has no light of its own. Deterministic.
bool are_lit_places_closed(const PreparedScene& scene, const FarPoints& points,
                           const ClosedShells& shells);

}  // namespace troffer
