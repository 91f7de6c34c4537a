// Scenes -> files: pbrt-v4 (.pbrt), glTF 2.0 (.gltf, .glb), chosen by ending. The layout of what is
// written follows the scene as it is in memory: instances have become copies.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "export/baked_light.h"
#include "export/output_folder.h"
#include "scene/scene.h"

namespace troffer {

// UsageError where the ending is none that is written.
void check_scene_format(const std::string& path);

// Writes the scene, emission, lights, cameras and materials included, with the files it needs
// beside it. Returns what the format cannot hold, in words. UsageError as above; EnvironmentError:
// what cannot be written.
// baked: of .gltf and .glb, light for its surfaces; null: none.
// up: of .gltf and .glb, the direction that becomes y; none: as scene/orientation.h decides.
// files: the folder of `path` with what has been written there already; null: nothing has.
std::vector<Warning> export_scene(Scene scene, const std::string& path,
                                  const BakedLight* baked = nullptr,
                                  const std::optional<Vec3>& up = std::nullopt,
                                  OutputFolder* files = nullptr);

}  // namespace troffer
