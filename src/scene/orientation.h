// Decides which way is up in a scene: by its format if that prescribes it, otherwise by evidence in
// the scene. Used by skies, measured luminaires, reports and exports to other axes.
#pragma once

#include <optional>
#include <string>

#include "base/vec.h"
#include "scene/scene.h"

namespace troffer {

enum class UpBasis {
  asked,       // --up
  format,      // glTF: y; Radiance: z
  evidence,    // cameras, names, standing objects and other hints (scene/up_hints.h)
  convention,  // no evidence; as in most files of the format
};

struct UpDecision {
  Vec3 up{0, 1, 0};  // unit, except for UpBasis::asked
  UpBasis basis = UpBasis::format;
  std::string reason;  // end of a sentence such as "z is up, by its cameras"
  // Sentence that another direction may be meant and that names --up: hints contradict each other
  // or the format, or there are none. Otherwise empty.
  std::string doubt;
};

// Decides for a scene as imported; lights added later by a sky option do not change the result.
// Costs one pass over at most two million triangles.
UpDecision decide_up(const Scene& scene);

// Decision for the direction of --up.
UpDecision requested_up(const Vec3& up);

// Returns "y" or "-z"; "0.6,0,0.8" for a direction along no axis.
std::string name_of_up(const Vec3& up);

// Returns "z is up, by its cameras".
std::string describe(const UpDecision& decision);

// True if the world is left-handed, as pbrt's is, judged by the handedness of the first camera. A
// pbrt file may mirror its camera to get a right-handed world.
bool is_mirrored(const Scene& scene);

}  // namespace troffer
