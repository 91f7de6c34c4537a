// numpy arrays as the façade's images and lists of numbers, and views of what the library owns.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <array>
#include <string>
#include <vector>

#include "troffer/image.h"
#include "troffer/material.h"
#include "troffer/render.h"

namespace troffer::bindings {

using Pixels = pybind11::array_t<float, pybind11::array::c_style | pybind11::array::forcecast>;

// (height, width, 3); UsageError for other shapes.
api::Image image_of(const Pixels& array);

// (height, width) or (height, width, channels): uint8 as bytes, other numbers as floats. Not
// checked beyond the shape.
api::TextureImage texture_of(const pybind11::array& array);

// A view that keeps its owner: (height, width, 3), or (height, width) of one channel.
pybind11::array view_of(const api::PixelView& view, const pybind11::object& owner);

// Rows of `columns` numbers; UsageError names the argument where the shape is another one.
template <class T, size_t columns>
std::vector<std::array<T, columns>> rows_of(const pybind11::object& value, const std::string& name);

// (n, 3) whole numbers from 0; TypeError for others.
std::vector<std::array<uint32_t, 3>> triangles_of(const pybind11::object& value);

}  // namespace troffer::bindings
