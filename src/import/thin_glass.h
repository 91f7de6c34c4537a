// Glass in sheets: a closed box of clear glass that is thin beside its sides is a pane.
#pragma once

#include "scene/scene.h"

namespace troffer {

// Puts a thin sheet in the middle of each closed prism of smooth dielectric or transmitting
// material whose thickness is at most a thirtieth of its smaller side: light goes through such a
// body as through one sheet with all reflections between its faces, but for a shift of less than
// the thickness. Its edges are left out. A mesh may hold several, beside other glass.
void replace_thin_glass(Scene& scene);

// Whether bodies of that material are looked at.
bool may_be_thin_glass(const Material& material);

}  // namespace troffer
