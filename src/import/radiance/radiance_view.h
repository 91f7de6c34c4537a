// Radiance's view options -> cameras.
//
// References: [1] Radiance manual pages rpict(1), rvu(1) (-vt -vp -vd -vu -vh -vv -vs -vl -vo -va).
#pragma once

#include <string>

#include "scene/scene.h"

namespace troffer {

// Appends the camera of a line such as "rvu -vtv -vp 0 0 1 -vd 0 1 0" to the scene, its position
// counted from the scene's origin. False where the line holds no view that can be used.
bool add_radiance_view(const std::string& line, const std::string& name, Scene& scene);

// The lines of a view file (.vf), which become the cameras view0, view1 …. InputError: a file that
// cannot be read.
void add_radiance_view_file(const std::string& path, Scene& scene);

}  // namespace troffer
