#include "python/arrays.h"

#include <cstdint>
#include <cstring>
#include <limits>

namespace troffer::bindings {

namespace py = pybind11;

api::Image image_of(const Pixels& a) {
  if (a.ndim() != 3 || a.shape(2) != 3 || a.shape(0) < 1 || a.shape(1) < 1)
    throw api::UsageError("a picture is an array of shape (height, width, 3)");
  constexpr py::ssize_t most = 1 << 20;
  if (a.shape(0) > most || a.shape(1) > most)
    throw api::UsageError("a picture has at most 1048576 rows and columns");
  return {int(a.shape(1)), int(a.shape(0)), std::vector<float>(a.data(), a.data() + a.size())};
}

api::TextureImage texture_of(const py::array& array) {
  const py::ssize_t most = std::numeric_limits<int>::max();
  const bool has_shape = array.ndim() == 2 || array.ndim() == 3;
  if (!has_shape || array.shape(0) > most || array.shape(1) > most)
    throw api::UsageError("an image is an array of shape (height, width) or (height, width, n)");
  api::TextureImage image;
  image.height = int(array.shape(0));
  image.width = int(array.shape(1));
  image.channels = array.ndim() == 2 ? 1 : int(std::min<py::ssize_t>(array.shape(2), 1 << 10));
  constexpr int flags = py::array::c_style | py::array::forcecast;
  if (py::isinstance<py::array_t<std::uint8_t>>(array)) {
    const py::array_t<std::uint8_t, flags> bytes(array);
    image.bytes.assign(bytes.data(), bytes.data() + bytes.size());
  } else {
    const py::array_t<float, flags> floats(array);
    image.floats.assign(floats.data(), floats.data() + floats.size());
  }
  return image;
}

py::array view_of(const api::PixelView& v, const py::object& owner) {
  const py::ssize_t number = sizeof(float);
  const py::ssize_t pixel = v.pixel_step * number;
  const py::ssize_t row = v.width * pixel;
  if (v.channels == 1) return py::array_t<float>({v.height, v.width}, {row, pixel}, v.data, owner);
  return py::array_t<float>({v.height, v.width, v.channels}, {row, pixel, number}, v.data, owner);
}

template <class T, size_t columns>
std::vector<std::array<T, columns>> rows_of(const py::object& value, const std::string& name) {
  if (value.is_none()) return {};
  const auto array = py::array_t<T, py::array::c_style | py::array::forcecast>::ensure(value);
  if (!array) {
    PyErr_Clear();
    throw py::type_error("argument '" + name + "' is an array of numbers");
  }
  if (array.ndim() != 2 || array.shape(1) != py::ssize_t(columns))
    throw api::UsageError(name + ": an array of shape (n, " + std::to_string(columns) + ")");
  std::vector<std::array<T, columns>> rows(size_t(array.shape(0)));
  if (!rows.empty()) std::memcpy(rows.data(), array.data(), size_t(array.size()) * sizeof(T));
  return rows;
}

template std::vector<std::array<double, 3>> rows_of(const py::object&, const std::string&);
template std::vector<std::array<double, 4>> rows_of(const py::object&, const std::string&);
template std::vector<std::array<float, 3>> rows_of(const py::object&, const std::string&);
template std::vector<std::array<float, 2>> rows_of(const py::object&, const std::string&);
template std::vector<std::array<std::int64_t, 3>> rows_of(const py::object&, const std::string&);

std::vector<std::array<uint32_t, 3>> triangles_of(const py::object& value) {
  const py::array any = py::array::ensure(value);
  if (!any) {
    PyErr_Clear();
    throw py::type_error("argument 'triangles' is an array of whole numbers");
  }
  if (any.size() > 0 && any.dtype().kind() != 'i' && any.dtype().kind() != 'u')
    throw py::type_error("argument 'triangles' is an array of whole numbers");
  std::vector<std::array<uint32_t, 3>> triangles;
  for (const auto& row : rows_of<std::int64_t, 3>(any, "triangles")) {
    std::array<uint32_t, 3> triangle{};
    for (size_t k = 0; k < 3; ++k) {
      if (row[k] < 0 || row[k] > std::int64_t(std::numeric_limits<uint32_t>::max()))
        throw api::UsageError("triangles: there is no vertex " + std::to_string(row[k]));
      triangle[k] = uint32_t(row[k]);
    }
    triangles.push_back(triangle);
  }
  return triangles;
}

std::vector<api::MeasurePoint> points_of(const Points& array, const api::Point& up) {
  if (array.ndim() != 2 || (array.shape(1) != 3 && array.shape(1) != 6))
    throw api::UsageError("points are an array of shape (n, 6), or (n, 3)");
  std::vector<api::MeasurePoint> points;
  const auto a = array.unchecked<2>();
  for (py::ssize_t i = 0; i < a.shape(0); ++i) {
    api::MeasurePoint p{{a(i, 0), a(i, 1), a(i, 2)}, up};
    if (a.shape(1) == 6) p.normal = {a(i, 3), a(i, 4), a(i, 5)};
    points.push_back(p);
  }
  return points;
}

}  // namespace troffer::bindings
