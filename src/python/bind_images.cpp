#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "compare/compare.h"
#include "image/read_image.h"
#include "image/write_image.h"
#include "python/bindings.h"

namespace troffer {

namespace py = pybind11;

namespace {

using Pixels = py::array_t<float, py::array::c_style | py::array::forcecast>;

Image image_of(const Pixels& a) {
  if (a.ndim() != 3 || a.shape(2) != 3 || a.shape(0) < 1 || a.shape(1) < 1)
    throw UsageError("a picture must be an array of shape (height, width, 3)");
  if (a.shape(0) > (1 << 20) || a.shape(1) > (1 << 20))
    throw UsageError("a picture has at most 1048576 rows and columns");
  Image image(int(a.shape(1)), int(a.shape(0)));
  const float* v = a.data();
  for (Rgb& p : image.pixels) {
    p = {v[0], v[1], v[2]};
    v += 3;
  }
  return image;
}

py::dict compare_arrays(const Pixels& image, const Pixels& reference) {
  const Image a = image_of(image), b = image_of(reference);
  Comparison c;
  {
    const py::gil_scoped_release unlocked;
    c = compare_images(a, b, "image");
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

py::array array_of(Image&& made) {
  auto* const image = new Image(std::move(made));
  const py::capsule owner(image, [](void* p) { delete static_cast<Image*>(p); });
  return py::array_t<float>({py::ssize_t(image->height), py::ssize_t(image->width), py::ssize_t(3)},
                            &image->pixels.data()->r, owner);
}

}  // namespace

double checked_exposure(double stops) {
  constexpr double most = 60;
  if (!(std::abs(stops) <= most)) throw UsageError("exposure must lie between -60 and 60 stops");
  return stops;
}

void bind_images(py::module_& m) {
  m.def(
      "compare", &compare_arrays, py::arg("image"), py::arg("reference"),
      "Compares a picture with a reference, both (height, width, 3). Returns a dict of mean_image, "
      "mean_reference, average_difference (of 8-bit sRGB values), rmse, relative_rmse, flip.");
  m.def(
      "read_image",
      [](const std::filesystem::path& path) {
        Image image;
        {
          const py::gil_scoped_release unlocked;
          image = read_image(path.string());
        }
        return array_of(std::move(image));
      },
      py::arg("path"),
      "Reads a picture file as linear light: float32 (height, width, 3). PNG, JPEG, WebP and TGA "
      "are decoded from sRGB.");
  m.def(
      "write_image",
      [](const std::filesystem::path& path, const Pixels& pixels, double exposure, bool is_filmic) {
        WriteOptions options;
        options.display = {checked_exposure(exposure), is_filmic ? ToneMap::filmic : ToneMap::none};
        write_image(path.string(), image_of(pixels), options);
      },
      py::arg("path"), py::arg("pixels"), py::kw_only(), py::arg("exposure") = 0.0,
      py::arg("filmic") = false,
      "Writes linear light (height, width, 3) to a file: .png (exposure in stops), .exr, .hdr or "
      ".pfm.");
}

}  // namespace troffer
