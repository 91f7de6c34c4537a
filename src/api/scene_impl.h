// Data behind the public classes Scene and Camera, and helpers that the files of Scene share.
// Lengths are in metres. Positions count from Scene::origin of the renderer's scene.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "api/script_scene.h"
#include "import/emissive.h"
#include "scene/scene.h"
#include "troffer/scene.h"

namespace troffer::api {

struct Camera::Impl {
  troffer::Camera camera;
  Vec3d origin;  // point from which the camera's position counts, m
};

struct Scene::Impl {
  ScriptScene script;
  std::optional<uint32_t> grey{};  // number of the material for shapes without one

  // Calls `add`, which appends to the scene. If it throws, the scene is as it was.
  template <class F>
  void append(const F& add) {
    const std::optional<uint32_t> before = grey;
    try {
      script.append(add);
    } catch (...) {
      grey = before;
      throw;
    }
  }

  // Returns the number of the material of that name. For "", adds the grey one if necessary. Throws
  // UsageError for an unknown name.
  uint32_t material_for(const std::string& name);
  // Returns the index of a texture, or no_texture for -1. Throws UsageError if it does not exist.
  int32_t texture_for(TextureId texture) const;
  // Returns the emission of a shape, named after the shape if it has no name of its own. Throws
  // UsageError for an invalid radiance or texture.
  std::optional<EmissionSpec> emission_for(const std::optional<Emission>& emission,
                                           const std::string& shape) const;
};

// Returns the camera with its position relative to the scene's origin.
troffer::Camera camera_in(const troffer::Scene& scene, const Camera& camera);

}  // namespace troffer::api
