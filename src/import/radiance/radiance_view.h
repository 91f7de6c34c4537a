// Converts Radiance's view options to cameras. Used by RadianceReader, for view comments and view
// files.
//
// References: [1] Radiance manual pages rpict(1), rvu(1) (-vt -vp -vd -vu -vh -vv -vs -vl -vo -va).
#pragma once

#include <string>

#include "scene/scene.h"

namespace troffer {

// Appends the camera of a line such as "rvu -vtv -vp 0 0 1 -vd 0 1 0" to the scene. Its position is
// relative to the scene's origin. Returns false if the line has no usable view.
bool add_radiance_view(const std::string& line, const std::string& name, Scene& scene);

// Appends the views of a view file (.vf) as cameras view0, view1 and so on. Throws InputError for
// unreadable files.
void add_radiance_view_file(const std::string& path, Scene& scene);

}  // namespace troffer
