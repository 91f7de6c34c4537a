// Importer of Honeybee models (.hbjson, or .json with such a model). Called by import_scene
// (import/import.h). Emission is radiance in W/(m² sr), at Radiance's 179 lm/W.
//
// References: [1] honeybee-schema (github.com/ladybug-tools/honeybee-schema), model.py; [2]
//   honeybee-radiance, writer.py (what of a model Radiance is given).
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>

#include "scene/scene.h"

namespace troffer {

// Returns the scene of a model, in metres. Faces of rooms are turned into the room; apertures and
// doors are cut out of them. Of two faces between rooms, the second is moved into its room by twice
// the tolerance, without its apertures [2]. Meshes are named by their room. Sensor grids and views
// become Scene::grids and Scene::cameras. `states` chooses the state of dynamic groups by name; the
// others show state 0. The windows of `blocked` groups are black.
//
// docs/reference/hbjson.md lists what is supported and left out. Throws InputError, with line and
// column, for malformed models, and UsageError for unknown groups and states.
Scene import_hbjson(const std::string& path, const std::map<std::string, size_t>& states = {},
                    const std::set<std::string>& blocked = {});

}  // namespace troffer
