// What a picture shows at one of its places: a point on a surface.
#pragma once

#include <optional>
#include <string>

#include "render/measure.h"
#include "transport/prepared_scene.h"

namespace troffer {

struct SeenPoint {
  MeasuringPoint point;  // in the file's coordinates; its normal, unit, on the side that is seen
  std::string name;      // of the mesh; empty: of a sphere or a disk, or it has none
};

// The first surface, panes of clear glass left out, on the ray through raster position (x, y), in
// pixels from the top left corner of a picture of this size. Nothing where the ray leaves the
// scene.
std::optional<SeenPoint> point_seen(const PreparedScene& scene, const Camera& camera, int width,
                                    int height, const Vec2& raster);

}  // namespace troffer
