// Scene.add_light(): keyword arguments as the façade's AddedLight.
#pragma once

#include <pybind11/pybind11.h>

#include "troffer/light.h"
#include "troffer/scene.h"

namespace troffer::bindings {

// The arguments in the words of the program's options. TypeError for values of the wrong type,
// UsageError for values without meaning.
api::AddedLight added_light(const pybind11::kwargs& asked);

// The text of help(Scene.add_light).
extern const char* const add_light_help;

}  // namespace troffer::bindings
