// The surface point that a picture shows at a raster position. The viewer uses it to pick points
// for measuring.
#pragma once

#include <optional>
#include <string>

#include "render/measure.h"
#include "transport/prepared_scene.h"

namespace troffer {

struct SeenPoint {
  MeasuringPoint point;  // in the file's coordinates; unit normal on the visible side
  std::string name;      // name of the mesh; empty for spheres, disks and unnamed meshes
};

// Returns the first surface, other than panes of clear glass, on the ray through a raster position.
// The position is in pixels from the top left corner of a picture of this size. Returns nothing if
// the ray leaves the scene.
std::optional<SeenPoint> point_seen(const PreparedScene& scene, const Camera& camera, int width,
                                    int height, const Vec2& raster);

}  // namespace troffer
