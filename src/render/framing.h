// A camera for a scene whose file has none.
#pragma once

#include "scene/scene.h"
#include "transport/prepared_scene.h"

namespace troffer {

// Whether the scene is one to stand in: most rays from places within its bounds meet the front of
// some surface. Within a body they meet backs, and beside an object nothing.
bool is_room(const PreparedScene& scene);

// From within a room, from the outside of anything else: `up_hint` lies nearest to the axis that
// the scene stands on.
Camera framing_camera(const PreparedScene& scene, const Vec3& up_hint);

}  // namespace troffer
