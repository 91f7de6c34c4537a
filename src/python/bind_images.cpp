#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <utility>

#include "python/arrays.h"
#include "python/bindings.h"
#include "troffer/image.h"

namespace troffer::bindings {

namespace py = pybind11;

namespace {

py::dict compare_arrays(const Pixels& image, const Pixels& reference) {
  const api::Image a = image_of(image), b = image_of(reference);
  api::ImageDifference c;
  {
    const py::gil_scoped_release unlocked;
    c = api::compare_images(a, b);
  }
  py::dict d;
  d["mean_image"] = c.mean_image;
  d["mean_reference"] = c.mean_reference;
  d["average_difference"] = c.average_difference;
  d["rmse"] = c.rmse;
  d["relative_rmse"] = c.relative_rmse;
  d["flip"] = c.flip;
  d["compared_pixels"] = c.compared_pixels;
  d["non_finite_pixels"] = c.non_finite_pixels;
  return d;
}

py::array array_of(api::Image&& made) {
  auto* const image = new api::Image(std::move(made));
  const py::capsule owner(image, [](void* p) { delete static_cast<api::Image*>(p); });
  return view_of({image->pixels.data(), image->width, image->height, 3, 3}, owner);
}

}  // namespace

void bind_images(py::module_& m) {
  m.def("compare", &compare_arrays, py::arg("image"), py::arg("reference"),
        "Compares a picture with a reference, both (height, width, 3). Returns a dict of "
        "mean_image, mean_reference, average_difference (of 8-bit sRGB values), rmse, "
        "relative_rmse, flip, compared_pixels, non_finite_pixels.");
  m.def(
      "read_image",
      [](const std::filesystem::path& path) {
        api::Image image;
        {
          const py::gil_scoped_release unlocked;
          image = api::read_image(path.string());
        }
        return array_of(std::move(image));
      },
      py::arg("path"),
      "Reads a picture file as linear light: float32 (height, width, 3). PNG, JPEG, WebP and TGA "
      "are decoded from sRGB.");
  m.def(
      "write_image",
      [](const std::filesystem::path& path, const Pixels& pixels, double exposure, bool is_filmic) {
        api::write_image(path.string(), image_of(pixels), {exposure, is_filmic});
      },
      py::arg("path"), py::arg("pixels"), py::kw_only(), py::arg("exposure") = 0.0,
      py::arg("filmic") = false,
      "Writes a picture of linear light (height, width, 3) as .png (exposure in stops), .exr, .hdr "
      "or .pfm.");
}

}  // namespace troffer::bindings
