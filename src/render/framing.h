// Choice of a camera for a scene whose file has none. It looks at rooms from inside and at objects
// from outside. Used by the commands render, report and view, and by the Python module.
#pragma once

#include "scene/scene.h"
#include "transport/prepared_scene.h"

namespace troffer {

// True if the scene is one to stand in: most rays from places within its bounds meet the front of
// some surface. Inside a body they meet backs, and beside an object nothing.
bool is_room(const PreparedScene& scene);

// Returns a camera inside a room, or outside anything else. The scene's vertical axis is the one
// nearest to `up_hint`.
Camera framing_camera(const PreparedScene& scene, const Vec3& up_hint);

}  // namespace troffer
