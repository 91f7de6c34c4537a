// What the camera sees of a scene that nothing has been built for yet.
#pragma once

#include "image/image.h"
#include "render/camera.h"
#include "render/film.h"
#include "scene/scene.h"

namespace troffer {

// A picture of the window, coarse and grey, as if light came from the camera: triangle by triangle,
// without a tracer, in a fraction of a second for millions of them. Spheres and disks are not
// shown.
Image first_sight(const Scene& scene, const ViewingCamera& camera, const PixelRect& window,
                  int threads);

}  // namespace troffer
