#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>

#include "python/arguments.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "troffer/measure.h"
#include "troffer/render.h"

namespace troffer::bindings {

namespace py = pybind11;

namespace {

using api::Kj92Options;
using api::LightOptions;
using api::RenderOptions;

const ArgumentTable<LightOptions>& light_arguments() {
  static const ArgumentTable<LightOptions> table{
      argument("method", &LightOptions::method), argument("indirect", &LightOptions::indirect),
      argument("error", &LightOptions::error),   argument("spp", &LightOptions::spp),
      argument("depth", &LightOptions::depth),   argument("threads", &LightOptions::threads),
      argument("seed", &LightOptions::seed),
  };
  return table;
}

const ArgumentTable<Kj92Options>& kj92_arguments() {
  static const ArgumentTable<Kj92Options> table{
      argument("variance", &Kj92Options::variance),
      argument("most_rays", &Kj92Options::most_rays),
      argument("mean_change", &Kj92Options::mean_change),
      argument("level_difference", &Kj92Options::level_difference),
      argument("probe_rays", &Kj92Options::probe_rays),
      argument("coherence", &Kj92Options::has_coherence),
      argument("ratio", &Kj92Options::uses_ratio),
      argument("selection", &Kj92Options::has_selection),
      argument("select", &Kj92Options::select),
  };
  return table;
}

const ArgumentTable<RenderOptions>& picture_arguments() {
  static const ArgumentTable<RenderOptions> table{
      argument("width", &RenderOptions::width),
      argument("height", &RenderOptions::height),
      argument("crop", &RenderOptions::crop),
      argument("max_spp", &RenderOptions::max_spp),
      argument("shadow_rays", &RenderOptions::shadow_rays),
      argument("aovs", &RenderOptions::aovs),
      argument("time_limit", &RenderOptions::time_limit),
      argument("error_limit", &RenderOptions::error_limit),
  };
  return table;
}

bool set_light_argument(const std::string& name, const py::handle& value, LightOptions& options) {
  return set_argument(light_arguments(), name, value, options) ||
         set_argument(kj92_arguments(), name, value, options.kj92);
}

std::unique_ptr<api::Picture> render_scene(api::Scene& s, const py::object& camera,
                                           const py::kwargs& arguments) {
  RenderOptions options;
  py::object progress = py::none();
  for (const auto& [key, value] : arguments) {
    const auto name = py::cast<std::string>(key);
    if (name == "progress")
      progress = py::reinterpret_borrow<py::object>(value);
    else if (!set_light_argument(name, value, options.light) &&
             !set_argument(picture_arguments(), name, value, options))
      fail_unknown("render", name);
  }
  std::optional<std::string> name;
  std::optional<api::Camera> given;
  if (camera.is_none() || py::isinstance<py::str>(camera))
    name = camera.is_none() ? "" : camera.cast<std::string>();
  else if (py::isinstance<api::Camera>(camera))
    given = camera.cast<api::Camera>();
  else
    throw py::type_error("camera: a name, a Camera or None");
  std::unique_ptr<api::Picture> made;
  run_for_python(progress, [&](const api::Progress& look) {
    const api::Picture picture =
        name && name->empty() ? api::render(s, options, look)
                              : api::render(s, name ? s.camera(*name) : *given, options, look);
    made = std::make_unique<api::Picture>(picture);
  });
  return made;
}

std::unique_ptr<api::Measurements> measure_scene(api::Scene& s, const Points& array,
                                                 const py::kwargs& arguments) {
  LightOptions options;
  py::object progress = py::none();
  for (const auto& [key, value] : arguments) {
    const auto name = py::cast<std::string>(key);
    if (name == "progress")
      progress = py::reinterpret_borrow<py::object>(value);
    else if (!set_light_argument(name, value, options))
      fail_unknown("measure", name);
  }
  const std::vector<api::MeasurePoint> points = points_of(array, s.up());
  auto made = std::make_unique<api::Measurements>();
  run_for_python(
      progress, [&](const api::Progress& look) { *made = api::measure(s, points, options, look); });
  return made;
}

}  // namespace

void bind_render(SceneClass& scene) {
  scene.def(
      "render", &render_scene, py::arg("camera") = py::none(),
      "Renders what a camera (a name, or a Camera) sees, as `troffer render` does.\n\nKeywords: "
      "width, height: pixels; 0 takes the camera's size, and one alone keeps the camera's "
      "proportions. crop: (x0, y0, x1, y1). method='certified'. indirect='auto'. error=0.01: "
      "allowed relative error of a pixel. spp, max_spp: viewing rays per pixel. shadow_rays. "
      "depth=-1. threads=0. seed=0. time_limit: seconds. error_limit. aovs: layers besides the "
      "picture ('albedo' 'normal' 'depth' 'position' 'direct' 'indirect' 'error' ...). progress: a "
      "function that this thread calls with the finished fraction; it stops the rendering by "
      "returning False.\nKeywords for the method kj92: variance, most_rays, mean_change, "
      "level_difference, probe_rays, coherence, ratio, selection, select.\n\nOther Python threads "
      "run during the rendering. Ctrl-C raises KeyboardInterrupt.");
  scene.def("measure", &measure_scene, py::arg("points"),
            "Returns the illuminance at points, as `troffer measure` does. points: float64 (n, 6), "
            "x, y, z in metres and the normal of the lit side; or (n, 3), which face "
            "up.\n\nKeywords: method, indirect, error, spp, depth, threads, seed, progress and "
            "those for the method kj92, as in render().");
}

}  // namespace troffer::bindings
