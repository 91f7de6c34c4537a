// Parts of the Python module. module.cpp calls the bind functions.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <functional>

#include "base/parallel.h"

namespace troffer {

// Binds InputError (a ValueError), and translates UsageError to ValueError and EnvironmentError to
// OSError.
void bind_errors(pybind11::module_& m);
// Binds Scene, its lights and materials, load(), look_at().
void bind_scene(pybind11::module_& m);
// Binds Picture, Measurements, Scene.render(), Scene.measure().
void bind_work(pybind11::module_& m);
// Binds compare(), read_image(), write_image().
void bind_images(pybind11::module_& m);

// Returns the exposure in stops. Throws UsageError if it is not between -60 and 60.
double checked_exposure(double stops);

// Runs work(stop, fraction) on another thread without the interpreter's lock. The calling thread
// handles signals (Ctrl-C raises KeyboardInterrupt) and calls progress(fraction), which may be
// None, with the lock held. An exception from either stops the work and is rethrown after the work
// has ended.
void run_for_python(
    const pybind11::object& progress,
    const std::function<void(const StopFlag& stop, std::atomic<double>& fraction)>& work);

}  // namespace troffer
