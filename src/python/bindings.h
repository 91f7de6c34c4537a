// The parts of the Python module. They bind the library's façade (troffer/) and nothing else.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <memory>

#include "troffer/scene.h"
#include "troffer/types.h"

namespace troffer::bindings {

using SceneClass = pybind11::class_<api::Scene, std::shared_ptr<api::Scene>>;

// InputError (a ValueError); UsageError becomes ValueError and EnvironmentError OSError.
void bind_errors(pybind11::module_& m);
// Camera, Scene, load(). Calls the four that follow it.
void bind_scene(pybind11::module_& m);
void bind_lights(pybind11::module_& m, SceneClass& scene);
void bind_materials(pybind11::module_& m, SceneClass& scene);
void bind_building(SceneClass& scene);
void bind_render(SceneClass& scene);
// Picture, Measurements.
void bind_results(pybind11::module_& m);
// compare(), read_image(), write_image().
void bind_images(pybind11::module_& m);

// Runs work(progress) without the interpreter's lock. Between pieces of work it handles signals
// (Ctrl-C raises KeyboardInterrupt) and calls callback(fraction), which may be None, with the lock;
// a callback that returns False stops the work, one that raises ends it.
void run_for_python(const pybind11::object& callback,
                    const std::function<void(const api::Progress& progress)>& work);

}  // namespace troffer::bindings
