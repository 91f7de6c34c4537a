// Scene.add_light() of Python: converts keyword arguments to AddedLight, whose texts have the form
// of the program's options.
#pragma once

#include <pybind11/pybind11.h>

#include "troffer/light.h"
#include "troffer/scene.h"

namespace troffer::bindings {

// Converts the arguments. Throws TypeError for unknown names and wrong types, and UsageError for
// invalid values.
api::AddedLight added_light(const pybind11::kwargs& asked);

// Text of help(Scene.add_light).
extern const char* const add_light_help;

}  // namespace troffer::bindings
