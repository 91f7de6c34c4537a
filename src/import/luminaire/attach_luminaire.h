// Luminaires in a scene: attached to existing geometry or lights, or added as bodies of their own.
// Used by `--luminaire` and by importers whose formats name photometric files. Intensities are in
// cd, positions count from Scene::origin.
#pragma once

#include <string>

#include "import/luminaire/luminaire.h"
#include "scene/scene.h"

namespace troffer {

// Makes `node` shine like the luminaire, with intensities times `scale`, which may be a colour.
// If a point, spot, disk or sphere light has that name, it gets the web. The nadir is a spot's
// direction or a disk's normal, and `down` for points and spheres. Otherwise the flat meshes of
// that name, or of lights of that name, become the luminous opening; their front faces the nadir.
// Throws UsageError if nothing has that name, or if it is not flat.
void attach_luminaire(Scene& scene, const std::string& node, const Luminaire& luminaire, Rgb scale,
                      const Vec3& down);

// Adds the luminaire's web with its own opening and returns the index in Scene::webs.
int32_t add_web(Scene& scene, const Luminaire& luminaire);

// Position and orientation of a luminaire without geometry of its own: its centre, its nadir, a
// direction in half-plane C0 (not parallel to the nadir), and straight down, from which its tilt is
// measured.
struct LuminairePlace {
  Vec3d position, nadir, along, down;
};

// Adds the luminaire as the body of its opening: faces shine where light leaves them and are black
// elsewhere. An opening without extent becomes a point light. `web` is the result of add_web().
void add_luminaire(Scene& scene, const std::string& name, const Luminaire& luminaire, int32_t web,
                   Rgb scale, const LuminairePlace& place);

}  // namespace troffer
