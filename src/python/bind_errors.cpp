#include "base/error.h"
#include "python/bindings.h"

namespace troffer {

namespace py = pybind11;

void bind_errors(py::module_& m) {
  static const py::exception<InputError> input_error(m, "InputError", PyExc_ValueError);
  input_error.attr("__doc__") =
      "A file that cannot be used; the text is 'FILE:LINE:COLUMN: problem'.";
  py::register_exception_translator([](std::exception_ptr p) {
    try {
      if (p) std::rethrow_exception(p);
    } catch (const InputError& e) {
      PyErr_SetString(input_error.ptr(), e.what());
    } catch (const UsageError& e) {
      PyErr_SetString(PyExc_ValueError, e.what());
    } catch (const EnvironmentError& e) {
      PyErr_SetString(PyExc_OSError, e.what());
    }
  });
}

}  // namespace troffer
