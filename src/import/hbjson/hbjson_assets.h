// Sensor grids and views of Honeybee models. Used by the importer of HBJSON.
#pragma once

#include "import/gltf/gltf_json.h"
#include "scene/scene.h"

namespace troffer {

// Adds the sensor grids and the views of a model's Radiance properties to the scene. A grid without
// sensors has one at the middle of each face of its mesh. unit_m: length of a unit, metres.
void add_hbjson_grids(const JsonNode& radiance, double unit_m, Scene& scene);
void add_hbjson_views(const JsonNode& radiance, double unit_m, Scene& scene);

}  // namespace troffer
