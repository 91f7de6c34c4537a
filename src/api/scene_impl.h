// Implementation of the façade's Scene and Camera.
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
  Vec3d origin;  // that its position counts from
};

struct Scene::Impl {
  ScriptScene script;
  std::optional<uint32_t> grey{};  // number of the material of shapes that name none

  // Number of the material that a shape names; adds the grey one for "". UsageError where there is
  // none of that name.
  uint32_t material_for(const std::string& name);
  // UsageError where the texture does not exist.
  int32_t texture_for(TextureId texture) const;
  // Emission of a shape of that name. UsageError for values without meaning.
  std::optional<EmissionSpec> emission_for(const std::optional<Emission>& emission,
                                           const std::string& shape) const;
};

// The camera as it stands in a scene of that origin.
troffer::Camera camera_in(const troffer::Scene& scene, const Camera& camera);

}  // namespace troffer::api
