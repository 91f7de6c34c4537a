// Measured luminaires take the place of what shines in a scene.
#pragma once

#include <string>

#include "import/luminaire/luminaire.h"
#include "scene/scene.h"

namespace troffer {

// Makes `node` shine as the luminaire does, its intensities times `scale`, which may be a colour: a
// point or spot of that name, whose direction becomes the nadir (points and spheres: straight down,
// `down`); flat meshes of that name, or those of lights of that name, disks and spheres among them,
// whose front becomes the luminous opening, facing the nadir. UsageError where there is nothing of
// that name, or it is not flat.
void attach_luminaire(Scene& scene, const std::string& node, const Luminaire& luminaire, Rgb scale,
                      const Vec3& down);

// The number in Scene::webs of a luminaire's own, with its opening.
int32_t add_web(Scene& scene, const Luminaire& luminaire);

// Where a luminaire that no part of the scene stands for hangs: its middle, from the scene's
// origin; where its nadir lies; what lies in its half-plane C0 (not parallel to that); the
// direction straight down, by which it is tilted.
struct LuminairePlace {
  Vec3d position, nadir, along, down;
};

// Adds it as what its file says of its opening: a body whose faces shine where light leaves them
// and are black elsewhere, or a point. `web`: of add_web().
void add_luminaire(Scene& scene, const std::string& name, const Luminaire& luminaire, int32_t web,
                   Rgb scale, const LuminairePlace& place);

}  // namespace troffer
