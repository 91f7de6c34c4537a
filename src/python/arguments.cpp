#include "python/arguments.h"

namespace troffer::bindings {

namespace py = pybind11;

template <>
bool taken<bool>(const py::handle& value, const std::string& name) {
  py::detail::make_caster<bool> caster;
  if (!caster.load(value, false)) throw py::type_error("argument '" + name + "' is True or False");
  return py::detail::cast_op<bool>(caster);
}

api::Color color_taken(const py::handle& value, const std::string& name) {
  if (py::isinstance<py::float_>(value) || py::isinstance<py::int_>(value)) {
    const auto grey = taken<float>(value, name);
    return {grey, grey, grey};
  }
  return taken<api::Color>(value, name);
}

void fail_unknown(const char* function, const std::string& name) {
  throw py::type_error(std::string(function) + "() has no argument '" + name + "'");
}

}  // namespace troffer::bindings
