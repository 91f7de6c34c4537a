// A material of a scene, as Python code holds it. The bindings of materials and meshes use it.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "troffer/scene.h"

namespace troffer::bindings {

struct MaterialHandle {
  std::shared_ptr<api::Scene> scene;  // kept alive by the handle
  std::size_t index;                  // in the scene; names may repeat

  std::string name() const;
};

}  // namespace troffer::bindings
