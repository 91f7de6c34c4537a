#include "python/bindings.h"

namespace troffer::bindings {

namespace py = pybind11;

void run_for_python(const py::object& callback,
                    const std::function<void(const api::Progress& progress)>& work) {
  double shown = -1;
  const auto look = [&](double fraction) {
    const py::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (callback.is_none() || fraction <= shown) return true;
    shown = fraction;
    return !callback(fraction).is(py::bool_(false));
  };
  const py::gil_scoped_release unlocked;
  work(look);
}

}  // namespace troffer::bindings
