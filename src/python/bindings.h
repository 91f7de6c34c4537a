// The parts of the Python module. They bind the public interface of the library (include/troffer)
// and use no other code. module.cpp calls them.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <memory>

#include "troffer/scene.h"
#include "troffer/types.h"

namespace troffer::bindings {

using SceneClass = pybind11::class_<api::Scene, std::shared_ptr<api::Scene>>;

// Binds InputError as a ValueError. Maps UsageError to ValueError and EnvironmentError to OSError.
void bind_errors(pybind11::module_& m);
// Binds Camera, Scene and load(), and calls the functions below except bind_images().
void bind_scene(pybind11::module_& m);
void bind_lights(pybind11::module_& m, SceneClass& scene);
void bind_materials(pybind11::module_& m, SceneClass& scene);
void bind_building(SceneClass& scene);
void bind_render(SceneClass& scene);
// Binds Picture and Measurements.
void bind_results(pybind11::module_& m);
// Binds AnnualDaylight, AnnualGrid and Scene.annual().
void bind_annual(pybind11::module_& m, SceneClass& scene);
// Binds compare(), read_image() and write_image().
void bind_images(pybind11::module_& m);

// Runs work(progress) without the interpreter's lock (GIL). progress() takes the lock, handles
// signals and calls callback(fraction); `callback` may be None. Ctrl-C raises KeyboardInterrupt.
// The work stops if the callback returns False, and ends with its exception if it raises.
void run_for_python(const pybind11::object& callback,
                    const std::function<void(const api::Progress& progress)>& work);

}  // namespace troffer::bindings
