// A material of a scene as Python holds it.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "troffer/scene.h"

namespace troffer::bindings {

struct MaterialHandle {
  std::shared_ptr<api::Scene> scene;  // lives as long as the handle
  std::size_t index;                  // number of the material; names may repeat

  std::string name() const;
};

}  // namespace troffer::bindings
