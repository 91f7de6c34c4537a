// Measured luminaires take the place of what shines in a scene.
#pragma once

#include <string>

#include "import/luminaire.h"
#include "scene/scene.h"

namespace troffer {

// Makes `node` shine as the luminaire does, its intensities times `scale`, which may be a colour: a
// point or spot of that name, whose direction becomes the nadir (points: straight down, `down`), or
// flat meshes of that name, or those of lights of that name, whose front becomes the luminous
// opening, facing the nadir. UsageError where there is nothing of that name, or it is not flat.
void attach_luminaire(Scene& scene, const std::string& node, const Luminaire& luminaire, Rgb scale,
                      const Vec3& down);

// Adds one that no part of the scene stands for, at a position from the scene's origin: its
// opening, a rectangle of its width and length, where it has one, else a point. `down` is where its
// nadir lies, `along` (not parallel to it) lies in its plane C0. `web`: of the scene's, its own.
void add_luminaire(Scene& scene, const std::string& name, const Luminaire& luminaire, int32_t web,
                   Rgb scale, const Vec3d& position, const Vec3d& down, const Vec3d& along);

}  // namespace troffer
