// Converts Mitsuba's emitter plugins without a surface to lights: points, spots, projectors,
// environments and skies. Used by MitsubaReader.
//
// References: [1] W. Jakob et al., "Mitsuba 3 documentation: Emitters"; [2] W. Jakob, "Mitsuba 0.6
//   Documentation", §8.7 (Emitters); [3] A. J. Preetham, P. Shirley, B. Smits, "A Practical
//   Analytic Model for Daylight", SIGGRAPH 1999 (appendix A.2: luminance).
#pragma once

#include "import/mitsuba/mitsuba_texture.h"
#include "import/mitsuba/mitsuba_tree.h"
#include "scene/scene.h"

namespace troffer {

// Appends the lights of an <emitter> without a shape to the scene. Positions are relative to the
// scene's origin. Unsupported emitters add warnings that name them. Throws InputError for unusable
// parameters.
void add_mitsuba_light(const MitsubaNode& node, const MitsubaTree& tree, MitsubaTextures& textures,
                       Scene& scene);

}  // namespace troffer
