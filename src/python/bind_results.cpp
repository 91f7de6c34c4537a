#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cstdint>
#include <filesystem>
#include <optional>

#include "python/arrays.h"
#include "python/bindings.h"
#include "troffer/measure.h"
#include "troffer/render.h"

namespace troffer::bindings {

namespace py = pybind11;

namespace {

py::array pixels_of(const py::object& self) {
  return view_of(self.cast<const api::Picture&>().pixels(), self);
}

py::array layer_named(const py::object& self, const std::string& name) {
  const auto& picture = self.cast<const api::Picture&>();
  if (!picture.has_layer(name)) throw py::key_error(name);
  return view_of(picture.layer(name), self);
}

py::object as_array(const py::object& self, const py::object& dtype, const py::object& copies) {
  const py::object pixels = pixels_of(self);
  if (!dtype.is_none()) return pixels.attr("astype")(dtype);
  const bool is_copied = !copies.is_none() && copies.cast<bool>();
  return is_copied ? py::object(pixels.attr("copy")()) : pixels;
}

py::bytes png_of(const api::Picture& picture) {
  const std::vector<std::uint8_t> bytes = picture.png();
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

py::dict stats_of(const api::Picture& picture) {
  const api::RenderStatistics& s = picture.statistics();
  py::dict d;
  d["width"] = s.width;
  d["height"] = s.height;
  d["end"] = s.end;
  d["build_seconds"] = s.build_seconds;
  d["preprocess_seconds"] = s.preprocess_seconds;
  d["render_seconds"] = s.render_seconds;
  d["estimated_error"] = s.estimated_error;
  d["viewing_error"] = s.viewing_error;
  d["share_above"] = s.share_above;
  d["share_done"] = s.share_done;
  d["gaps_filled"] = s.gaps_filled;
  d["unsampled"] = s.unsampled;
  d["viewing_rays"] = s.viewing_rays;
  d["surrogate_samples"] = s.surrogate_samples;
  d["extension_rays"] = s.extension_rays;
  d["shadow_rays"] = s.shadow_rays;
  d["nan_samples"] = s.nan_samples;
  d["lit_certified"] = s.lit_certified;
  d["dark_certified"] = s.dark_certified;
  d["masked"] = s.masked;
  d["mixed"] = s.mixed;
  d["is_by_paths"] = s.is_by_paths;
  d["cells"] = s.cells;
  d["cell_rays"] = s.cell_rays;
  d["cell_size"] = s.cell_size;
  d["cell_seconds"] = s.cell_seconds;
  d["cell_bytes"] = s.cell_bytes;
  return d;
}

void bind_picture(py::module_& m) {
  py::class_<api::Picture>(m, "Picture", "What Scene.render() makes.")
      .def_property_readonly(
          "pixels", &pixels_of,
          "Linear light, float32 (height, width, 3), row 0 on top. It is a view, not a copy.")
      .def("__getitem__", &layer_named, py::arg("layer"),
           "Returns a requested layer (aovs=) as a view: float32 (height, width, 3) or (height, "
           "width).")
      .def("__array__", &as_array, py::arg("dtype") = py::none(), py::arg("copy") = py::none(),
           "Returns the pixels, for numpy.asarray().")
      .def_property_readonly("layers", &api::Picture::layer_names,
                             "Names of the layers besides the picture.")
      .def_property_readonly(
          "error", [](const api::Picture& p) { return p.statistics().estimated_error; },
          "Estimated error of the picture: root mean square of the pixels' standard errors, "
          "divided by the mean luminance, as a display shows the picture.")
      .def_property_readonly("is_complete", &api::Picture::is_complete,
                             "False after a stop or a time limit.")
      .def_property_readonly(
          "stats", &stats_of,
          "Dict of statistics of the rendering: seconds, rays, errors, cache cells.")
      .def(
          "save",
          [](const api::Picture& p, const std::filesystem::path& path,
             const std::optional<double>& exposure, bool is_filmic) {
            p.save(path.string(), {exposure, is_filmic});
          },
          py::arg("path"), py::kw_only(), py::arg("exposure") = py::none(),
          py::arg("filmic") = true,
          "Writes the picture as .png, .exr (with all layers), .hdr or .pfm (linear). exposure: "
          "stops, for .png; chosen automatically if it is left out. filmic: applies a tone map.")
      .def("_repr_png_", &png_of, "The picture as notebooks show it.")
      .def("__repr__", [](const api::Picture& p) {
        return "<troffer.Picture " + std::to_string(p.width()) + " x " +
               std::to_string(p.height()) + ">";
      });
}

// Returns a view of one member of all measurements.
py::array column(const py::object& self, const double api::Measurement::*member) {
  const auto& values = self.cast<const api::Measurements&>().values;
  const double* const first = values.empty() ? nullptr : &(values.front().*member);
  return py::array_t<double>({py::ssize_t(values.size())}, {py::ssize_t(sizeof(api::Measurement))},
                             first, self);
}

void bind_measurements(py::module_& m) {
  py::class_<api::Measurements>(m, "Measurements", "What Scene.measure() finds, point by point.")
      .def_property_readonly(
          "illuminance",
          [](const py::object& self) { return column(self, &api::Measurement::illuminance); },
          "Illuminance in lx, float64 (n,).")
      .def_property_readonly(
          "standard_error",
          [](const py::object& self) { return column(self, &api::Measurement::standard_error); },
          "Standard error of the illuminance in lx, float64 (n,). 95 % of the intervals of 1.96 "
          "standard errors around it contain the true value.")
      .def_property_readonly(
          "irradiance",
          [](const py::object& self) {
            const auto& values = self.cast<const api::Measurements&>().values;
            const float* const first = values.empty() ? nullptr : values.front().irradiance.data();
            return py::array_t<float>(
                {py::ssize_t(values.size()), py::ssize_t(3)},
                {py::ssize_t(sizeof(api::Measurement)), py::ssize_t(sizeof(float))}, first, self);
          },
          "Irradiance of each channel in W/m2, or in lx if Scene.is_photometric, float32 (n, 3).")
      .def_readonly("is_complete", &api::Measurements::is_complete, "False after a stop.")
      .def("__len__", [](const api::Measurements& r) { return r.values.size(); });
}

}  // namespace

void bind_results(py::module_& m) {
  bind_picture(m);
  bind_measurements(m);
}

}  // namespace troffer::bindings
