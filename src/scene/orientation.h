// Which way a scene stands, where its file does not say.
#pragma once

#include "base/vec.h"
#include "scene/scene.h"

namespace troffer {

// The axis a scene stands on: y for glTF; for formats that do not say, the one of y and z along
// which it extends less.
Vec3 guess_up(const Scene& scene);

// Whether its world is left-handed, as pbrt's own is. A camera that keeps the hand of a
// right-handed world says that the world is one; pbrt's is not, where its camera has not mirrored
// it back.
bool is_mirrored(const Scene& scene);

}  // namespace troffer
