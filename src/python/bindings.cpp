#include "python/bindings.h"
#include "python/script_scene.h"

namespace troffer {

namespace py = pybind11;

void run_for_python(
    const py::object& progress,
    const std::function<void(const StopFlag& stop, std::atomic<double>& fraction)>& work) {
  std::atomic<double> fraction{0};
  double told = -1;
  const auto look = [&] {
    const py::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    const double now = fraction;
    if (progress.is_none() || now <= told) return;
    told = now;
    progress(now);
  };
  const py::gil_scoped_release unlocked;
  run_watched([&](const StopFlag& stop) { work(stop, fraction); }, look);
}

}  // namespace troffer
