// What the Python module is made of.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <functional>

#include "base/parallel.h"

namespace troffer {

// InputError (a ValueError), and what the house's other failures are to Python: UsageError a
// ValueError, EnvironmentError an OSError.
void bind_errors(pybind11::module_& m);
// Scene, its lights and materials, load(), look_at().
void bind_scene(pybind11::module_& m);
// Picture, Measurements, Scene.render(), Scene.measure().
void bind_work(pybind11::module_& m);
// compare(), read_image(), write_image().
void bind_images(pybind11::module_& m);

// Stops of exposure; UsageError where it is not between -60 and 60.
double checked_exposure(double stops);

// Runs work(stop, fraction) without the interpreter's lock, on another thread; this one handles
// signals (Ctrl-C raises KeyboardInterrupt) and calls progress(fraction), which may be None, with
// the lock. What either raises stops the work and is raised once it has ended.
void run_for_python(
    const pybind11::object& progress,
    const std::function<void(const StopFlag& stop, std::atomic<double>& fraction)>& work);

}  // namespace troffer
