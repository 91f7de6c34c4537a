#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "base/error.h"
#include "image/exposure.h"
#include "image/write_image.h"
#include "python/bindings.h"
#include "python/script_scene.h"
#include "render/aov_rows.h"
#include "render/measure.h"
#include "render/preparation.h"
#include "render/render.h"
#include "scene/orientation.h"

namespace troffer {

namespace py = pybind11;

namespace {

using Points = py::array_t<double, py::array::c_style | py::array::forcecast>;

// Returns a view of the pixels, which `owner` keeps alive: (height, width, 3), or (height, width)
// for a layer of one channel.
py::array view_of(const Layer& layer, const py::object& owner) {
  const Image& image = layer.image;
  const py::ssize_t w = image.width, h = image.height, pixel = sizeof(Rgb), channel = sizeof(float);
  const float* const first = &image.pixels.data()->r;
  if (layer.channels.size() == 1)
    return py::array_t<float>({h, w}, {w * pixel, pixel}, first, owner);
  return py::array_t<float>({h, w, py::ssize_t(3)}, {w * pixel, pixel, channel}, first, owner);
}

py::array layer_named(const py::object& self, const std::string& name) {
  for (const Layer& layer : self.cast<const RenderResult&>().layers)
    if (layer.name == name) return view_of(layer, self);
  throw py::key_error(name);
}

std::vector<std::string> layer_names(const RenderResult& r) {
  std::vector<std::string> names;
  for (size_t i = 1; i < r.layers.size(); ++i) names.push_back(r.layers[i].name);
  return names;
}

void save(const RenderResult& r, const std::filesystem::path& path, std::optional<double> exposure,
          bool is_filmic) {
  WriteOptions options;
  const double stops =
      exposure ? checked_exposure(*exposure) : brightness(r.layers[0].image).auto_stops;
  options.display = {stops, is_filmic ? ToneMap::filmic : ToneMap::none};
  write_image(path.string(), r.layers, options);
}

void bind_picture(py::module_& m) {
  py::class_<RenderResult>(m, "Picture", "Result of Scene.render().")
      .def_property_readonly(
          "pixels",
          [](const py::object& self) {
            return view_of(self.cast<const RenderResult&>().layers[0], self);
          },
          "float32 (height, width, 3), row 0 on top, linear light; a view, not a copy.")
      .def("__getitem__", &layer_named, py::arg("layer"),
           "A requested layer (aovs=): float32 (height, width, 3) or (height, width), a view.")
      .def_property_readonly("layers", &layer_names, "Names of the layers besides the picture.")
      .def_property_readonly(
          "error", [](const RenderResult& r) { return r.statistics.estimated_error; },
          "Estimated error of the picture: root mean square of the pixels' standard errors, over "
          "the mean luminance.")
      .def_property_readonly("is_complete", [](const RenderResult& r) { return r.is_complete; })
      .def("save", &save, py::arg("path"), py::kw_only(), py::arg("exposure") = py::none(),
           py::arg("filmic") = true,
           "Writes .png (exposure in stops, automatic if not given; filmic: with a tone curve), "
           ".exr (with all layers), .hdr or .pfm (linear).");
}

Aov aov_named(const std::string& name) {
  if (const std::optional<Aov> aov = find_aov(name)) return *aov;
  throw UsageError("there is no layer '" + name + "'");
}

// Arguments that render() and measure() share.
struct Common {
  std::string method = "certified", indirect = "auto";
  double error = 0.01;
  int spp = 0, depth = -1, threads = 0;
  uint64_t seed = 0;

  template <class Options>
  void set(Options& options) const {
    const std::optional<Method> m = Method::find(method);
    if (!m) throw UsageError("there is no method '" + method + "', but " + Method::names());
    const std::optional<Indirect> i = Indirect::find(indirect);
    if (!i) throw UsageError("indirect must be 'auto', 'none', 'radiosity' or 'cells'");
    if (!(error > 0 && error <= 1)) throw UsageError("error must be above 0 and at most 1");
    if (spp < 0 || spp > (1 << 24)) throw UsageError("spp must lie between 0 and 16777216");
    if (depth < -1) throw UsageError("depth must be at least 0, or -1 for no limit");
    if (threads < 0 || threads > 4096) throw UsageError("threads must lie between 0 and 4096");
    options.method = *m;
    options.indirect = *i;
    options.error = error;
    options.depth = depth;
    options.threads = threads;
    options.seed = seed;
  }
};

// Prepares the radiosity that some methods need. Null for other methods, and if `stop` was set.
template <class Options>
std::unique_ptr<Preparation> prepared_for(const PreparedScene& scene, const Options& o,
                                          const StopFlag& stop) {
  return prepare(
      scene, o.method, o.kj92, o.indirect, std::nullopt, o.threads, [](double) {}, stop);
}

struct PictureRequest {
  int width = 0, height = 0, max_spp = 0;
  std::vector<std::string> aovs;

  RenderOptions options(const Common& common) const {
    RenderOptions o;
    common.set(o);
    if (common.spp > 0) o.spp = common.spp;
    constexpr int largest = 65536;
    if (width < 0 || height < 0 || width > largest || height > largest)
      throw UsageError("width and height must lie between 0 and 65536");
    if (max_spp < 0 || max_spp > (1 << 20))
      throw UsageError("max_spp must lie between 0 and 1048576");
    o.width = width;
    o.height = height;
    o.max_spp = max_spp;
    for (const std::string& name : aovs) o.aovs.push_back(aov_named(name));
    return o;
  }
};

std::unique_ptr<RenderResult> render_scene(ScriptScene& s, const py::object& camera,
                                           const Common& common, const PictureRequest& request,
                                           const py::object& progress) {
  RenderOptions options = request.options(common);
  std::optional<std::string> name;
  std::optional<Camera> given;
  if (camera.is_none() || py::isinstance<py::str>(camera))
    name = camera.is_none() ? "" : camera.cast<std::string>();
  else if (py::isinstance<Camera>(camera))
    given = camera.cast<Camera>();
  else
    throw py::type_error("camera must be a name, a Camera or None");
  auto result = std::make_unique<RenderResult>();
  run_for_python(progress, [&](const StopFlag& stop, std::atomic<double>& fraction) {
    const Camera seen_from = name ? s.camera(*name) : *given;
    const std::shared_ptr<const PreparedScene> scene = s.prepared();
    check_options(*scene, seen_from, options);
    const std::unique_ptr<Preparation> preparation = prepared_for(*scene, options, stop);
    if (stop) return;
    options.preparation = preparation.get();
    *result = render(
        *scene, seen_from, options, [&](double f) { fraction = f; }, stop);
  });
  return result;
}

// Parses an array of shape (n, 6) with positions and normals, or (n, 3) with positions alone and
// `up` as the normal.
std::vector<MeasuringPoint> measuring_points(const Points& array, Vec3 up) {
  if (array.ndim() != 2 || (array.shape(1) != 3 && array.shape(1) != 6))
    throw UsageError("points must be an array of shape (n, 6) or (n, 3)");
  std::vector<MeasuringPoint> points;
  const auto a = array.unchecked<2>();
  for (py::ssize_t i = 0; i < a.shape(0); ++i) {
    MeasuringPoint p{{a(i, 0), a(i, 1), a(i, 2)}, up};
    if (a.shape(1) == 6) p.normal = {float(a(i, 3)), float(a(i, 4)), float(a(i, 5))};
    const double all = p.position.x + p.position.y + p.position.z + double(dot(p.normal, p.normal));
    if (!std::isfinite(all) || dot(p.normal, p.normal) == 0)
      throw UsageError("points must be finite numbers, and normals must not be zero");
    points.push_back(p);
  }
  return points;
}

std::unique_ptr<MeasureResult> measure_scene(ScriptScene& s, const Points& array,
                                             const Common& common, const py::object& progress) {
  MeasureOptions options;
  common.set(options);
  options.spp = common.spp;
  const std::vector<MeasuringPoint> points = measuring_points(array, decide_up(s.scene()).up);
  auto result = std::make_unique<MeasureResult>();
  run_for_python(progress, [&](const StopFlag& stop, std::atomic<double>& fraction) {
    const std::shared_ptr<const PreparedScene> scene = s.prepared();
    const std::unique_ptr<Preparation> preparation = prepared_for(*scene, options, stop);
    if (stop) return;
    options.preparation = preparation.get();
    *result = measure(
        *scene, points, options, [&](double f) { fraction = f; }, stop);
  });
  return result;
}

// Returns a view of one member of every row.
template <class T>
py::array column(const py::object& self, const T Measurement::*member) {
  const auto& values = self.cast<const MeasureResult&>().values;
  const T* const first = values.empty() ? nullptr : &(values.front().*member);
  return py::array_t<T>({py::ssize_t(values.size())}, {py::ssize_t(sizeof(Measurement))}, first,
                        self);
}

void bind_measurements(py::module_& m) {
  py::class_<MeasureResult>(m, "Measurements", "Result of Scene.measure(), point by point.")
      .def_property_readonly(
          "illuminance",
          [](const py::object& self) { return column(self, &Measurement::illuminance_lx); },
          "float64 (n,), lx.")
      .def_property_readonly(
          "standard_error",
          [](const py::object& self) { return column(self, &Measurement::standard_error); },
          "float64 (n,), lx: illuminance +- 1.96 of these contains the true value in 95 of 100 "
          "cases.")
      .def_property_readonly(
          "irradiance",
          [](const py::object& self) {
            const auto& values = self.cast<const MeasureResult&>().values;
            const float* const first = values.empty() ? nullptr : &values.front().irradiance.r;
            return py::array_t<float>(
                {py::ssize_t(values.size()), py::ssize_t(3)},
                {py::ssize_t(sizeof(Measurement)), py::ssize_t(sizeof(float))}, first, self);
          },
          "float32 (n, 3): W/m2 by channel, or lx where Scene.is_photometric.")
      .def("__len__", [](const MeasureResult& r) { return r.values.size(); });
}

}  // namespace

void bind_work(py::module_& m) {
  bind_picture(m);
  bind_measurements(m);
  auto scene = m.attr("Scene").cast<py::class_<ScriptScene, std::shared_ptr<ScriptScene>>>();
  scene.def(
      "render",
      [](ScriptScene& s, const py::object& camera, int width, int height, const std::string& method,
         double error, int spp, int max_spp, const std::string& indirect,
         const std::vector<std::string>& aovs, int depth, int threads, uint64_t seed,
         const py::object& progress) {
        return render_scene(s, camera, {method, indirect, error, spp, depth, threads, seed},
                            {width, height, max_spp, aovs}, progress);
      },
      py::arg("camera") = py::none(), py::kw_only(), py::arg("width") = 0, py::arg("height") = 0,
      py::arg("method") = "certified", py::arg("error") = 0.01, py::arg("spp") = 0,
      py::arg("max_spp") = 0, py::arg("indirect") = "auto",
      py::arg("aovs") = std::vector<std::string>{}, py::arg("depth") = -1, py::arg("threads") = 0,
      py::arg("seed") = 0, py::arg("progress") = py::none(),
      "Renders the view of a camera (a name, or a Camera), as `troffer render` does. width, "
      "height: pixels; 0: the camera's size (if only one is given, the other follows from the "
      "camera's proportions); error: allowed standard error of a pixel, relative; aovs: layers "
      "besides the picture ('albedo' 'normal' 'depth' 'position' 'direct' 'indirect' 'error' ...); "
      "progress: called with the fraction done, from this thread. Other threads run meanwhile; "
      "Ctrl-C raises KeyboardInterrupt.");
  scene.def(
      "measure",
      [](ScriptScene& s, const Points& points, const std::string& method, double error, int spp,
         const std::string& indirect, int depth, int threads, uint64_t seed,
         const py::object& progress) {
        return measure_scene(s, points, {method, indirect, error, spp, depth, threads, seed},
                             progress);
      },
      py::arg("points"), py::kw_only(), py::arg("method") = "certified", py::arg("error") = 0.01,
      py::arg("spp") = 0, py::arg("indirect") = "auto", py::arg("depth") = -1,
      py::arg("threads") = 0, py::arg("seed") = 0, py::arg("progress") = py::none(),
      "Measures illuminance at points, as `troffer measure` does. points: float64 (n, 6): x, y, z "
      "in metres and the normal of the lit side; or (n, 3): facing up.");
}

}  // namespace troffer
