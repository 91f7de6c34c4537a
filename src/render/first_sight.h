// A quick picture of a scene for which nothing has been built yet. The preview shows it while
// images are being read and the tracer is being built.
#pragma once

#include "image/image.h"
#include "render/camera.h"
#include "render/film.h"
#include "scene/scene.h"

namespace troffer {

// Returns a coarse grey picture of the window, lit from the camera. It projects triangle by
// triangle without a tracer, in a fraction of a second for millions of triangles. Spheres and disks
// are not shown.
Image first_sight(const Scene& scene, const ViewingCamera& camera, const PixelRect& window,
                  int threads);

}  // namespace troffer
