// Conversions from numpy arrays to images and lists of numbers of the C++ library, and numpy views
// of pixels that the library owns. Row 0 of images is on top.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <array>
#include <string>
#include <vector>

#include "troffer/image.h"
#include "troffer/material.h"
#include "troffer/measure.h"
#include "troffer/render.h"

namespace troffer::bindings {

using Points = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;
using Pixels = pybind11::array_t<float, pybind11::array::c_style | pybind11::array::forcecast>;

// Converts an array (height, width, 3). Throws UsageError for other shapes.
api::Image image_of(const Pixels& array);

// Converts an array (height, width) or (height, width, channels): uint8 to bytes, other numbers to
// floats. Throws UsageError for other shapes; Scene::add_texture() checks the rest.
api::TextureImage texture_of(const pybind11::array& array);

// Returns a view (height, width, 3), or (height, width) for one channel. It keeps its owner alive.
pybind11::array view_of(const api::PixelView& view, const pybind11::object& owner);

// Converts an array (n, columns); None gives no rows. Throws UsageError for other shapes and
// TypeError for other objects; both name the argument.
template <class T, size_t columns>
std::vector<std::array<T, columns>> rows_of(const pybind11::object& value, const std::string& name);

// Converts an array (n, 3) of whole numbers. Throws TypeError for other numbers and UsageError for
// other shapes and for numbers outside [0, 2^32).
std::vector<std::array<uint32_t, 3>> triangles_of(const pybind11::object& value);

// Converts (n, 6): position and normal; or (n, 3): positions whose normals are `up`. Throws
// UsageError for other shapes.
std::vector<api::MeasurePoint> points_of(const Points& array, const api::Point& up);

}  // namespace troffer::bindings
