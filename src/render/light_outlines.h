// Outlines of the scene's lights as a camera sees them: where something small and bright meets its
// surroundings is known before any sample is drawn.
#pragma once

#include <vector>

#include "integrate/prepared_scene.h"
#include "render/camera.h"
#include "render/tile.h"

namespace troffer {

// The pixels of the region through which the outline of a light goes that the camera sees directly,
// each any number of times. Disks and spheres are taken as polygons of 16 corners. With a lens: as
// seen from its middle.
std::vector<Pixel2> pixels_on_light_outlines(const PreparedScene& scene,
                                             const ViewingCamera& camera, const PixelRect& region);

}  // namespace troffer
