// Exports scenes to pbrt-v4 (.pbrt) or glTF 2.0 (.gltf, .glb), chosen by extension. The `convert`
// and `bake` commands use it. The output has the structure of the scene in memory. Properties that
// a format cannot express become warnings.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "export/baked_light.h"
#include "export/output_folder.h"
#include "scene/scene.h"

namespace troffer {

// Throws UsageError if the extension is not supported.
void check_scene_format(const std::string& path);

// Writes the scene with emission, lights, cameras and materials, and the files that it needs next
// to it. Returns warnings about what the format cannot express. Throws UsageError as above,
// EnvironmentError if a file cannot be written.
// - baked: light for the surfaces, glTF only; null: none.
// - up: direction that becomes y, glTF only; none: decided by scene/orientation.h.
// - files: folder of `path` with files that were already written there; null: none.
std::vector<Warning> export_scene(Scene scene, const std::string& path,
                                  const BakedLight* baked = nullptr,
                                  const std::optional<Vec3>& up = std::nullopt,
                                  OutputFolder* files = nullptr);

}  // namespace troffer
