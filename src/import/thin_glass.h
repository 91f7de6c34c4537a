// Replacement of thin glass bodies by sheets: a closed prism of clear glass that is thin compared
// with its sides becomes a pane, through which light passes without refraction. import_scene()
// applies it to all formats.
#pragma once

#include "scene/scene.h"

namespace troffer {

// Replaces each closed prism of smooth dielectric or transmitting material by a thin sheet in its
// middle. The thickness must be at most 1/30 of the smaller side. Light passes as through the body,
// with all reflections between its faces, but without the shift, which is less than the thickness.
// The prism's edges are dropped. A mesh may contain several prisms beside other glass.
void replace_thin_glass(Scene& scene);

// True if bodies of that material are candidates.
bool may_be_thin_glass(const Material& material);

}  // namespace troffer
