// Which way a scene stands: by its format where that says it, else by what the scene shows.
// Skies, measured luminaires, reports and exports to other axes depend on it.
#pragma once

#include <optional>
#include <string>

#include "base/vec.h"
#include "scene/scene.h"

namespace troffer {

enum class UpBasis {
  asked,       // --up
  format,      // glTF: y; Radiance: z
  evidence,    // cameras, names, objects that stand on others … (scene/up_hints.h)
  convention,  // nothing in the file says; most files of the format have it so
};

struct UpDecision {
  Vec3 up{0, 1, 0};  // unit, unless asked
  UpBasis basis = UpBasis::format;
  std::string reason;  // ends a sentence "z is up …": "by its cameras"
  // A sentence where another direction may be meant: hints contradict each other or the format, or
  // there are none. Empty elsewhere. It names --up.
  std::string doubt;
};

// Decides for a scene as it was read; the same for a scene with further lights from `up`'s sky.
// The cost is one pass over at most two million triangles.
UpDecision decide_up(const Scene& scene);

// The direction that --up asked for.
UpDecision asked_up(const Vec3& up);

// "y", "-z"; "0.6,0,0.8" for a direction along no axis.
std::string name_of_up(const Vec3& up);

// "z is up, by its cameras".
std::string describe(const UpDecision& decision);

// Whether its world is left-handed, as pbrt's own is. A camera that keeps the hand of a
// right-handed world says that the world is one; pbrt's is not, where its camera has not mirrored
// it back.
bool is_mirrored(const Scene& scene);

}  // namespace troffer
