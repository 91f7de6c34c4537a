#include "python/bindings.h"
#include "troffer/scene.h"

namespace troffer::bindings {

namespace py = pybind11;

void bind_errors(py::module_& m) {
  static const py::exception<api::InputError> input_error(m, "InputError", PyExc_ValueError);
  input_error.attr("__doc__") = "A file that cannot be used as it is: 'FILE:LINE:COLUMN: what'.";
  py::register_exception_translator([](std::exception_ptr p) {
    try {
      if (p) std::rethrow_exception(p);
    } catch (const api::InputError& e) {
      PyErr_SetString(input_error.ptr(), e.what());
    } catch (const api::UsageError& e) {
      PyErr_SetString(PyExc_ValueError, e.what());
    } catch (const api::EnvironmentError& e) {
      PyErr_SetString(PyExc_OSError, e.what());
    }
  });
}

}  // namespace troffer::bindings
