#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "python/bindings.h"

namespace troffer::bindings {

namespace py = pybind11;

namespace {

void bind_facts(SceneClass& scene) {
  scene
      .def_property_readonly(
          "file", [](const api::Scene& s) { return s.file(); },
          "Path that was passed to load(); '' for a built scene.")
      .def_property_readonly("warnings", &api::Scene::warnings,
                             "Warnings about the file, one string each.")
      .def_property_readonly("is_photometric", &api::Scene::is_photometric,
                             "True if light is in cd/m2 (glTF), false if it is in W/(m2 sr).")
      .def_property_readonly("triangles", &api::Scene::triangle_count, "Number of triangles.")
      .def_property_readonly("up", &api::Scene::up, "(x, y, z): the upward direction.")
      .def_property_readonly("cameras", &api::Scene::camera_names, "Names of the cameras.")
      .def_property_readonly(
          "bounds",
          [](const api::Scene& s) {
            const auto [lower, upper] = s.bounds();
            return py::make_tuple(py::make_tuple(lower[0], lower[1], lower[2]),
                                  py::make_tuple(upper[0], upper[1], upper[2]));
          },
          "Lower and upper corner in metres: ((x, y, z), (x, y, z)).")
      .def("camera", &api::Scene::camera, py::arg("name") = "",
           "Returns the camera of this name. Without a name, returns the first camera, or one that "
           "frames the scene if it has none.")
      .def("__repr__", [](const api::Scene& s) { return "<troffer.Scene '" + s.file() + "'>"; });
}

void bind_load(py::module_& m) {
  m.def(
      "load",
      [](const std::filesystem::path& file, const std::optional<std::string>& variant,
         const std::optional<double>& time, const std::optional<std::string>& animation,
         double emission_scale, bool shows_baked) {
        const py::gil_scoped_release unlocked;
        return std::make_shared<api::Scene>(api::Scene::load(
            file.string(), {variant, time, animation, emission_scale, shows_baked}));
      },
      py::arg("file"), py::kw_only(), py::arg("variant") = py::none(), py::arg("time") = py::none(),
      py::arg("animation") = py::none(), py::arg("emission_scale") = 1.0, py::arg("baked") = false,
      "Loads a scene from a path (str or os.PathLike): .gltf .glb .pbrt .obj .stl .ply .xml "
      "(Mitsuba), .rad or .hbjson. variant: name of a set of glTF materials. time: seconds into "
      "the "
      "animation. emission_scale: factor on the emission of the file's surfaces. baked: shows the "
      "light that `troffer bake` wrote. Raises InputError.");
}

}  // namespace

void bind_scene(py::module_& m) {
  py::class_<api::Camera>(m, "Camera", "What a picture is seen from: look_at(), Scene.camera().")
      .def_property_readonly(
          "name", [](const api::Camera& c) { return c.name(); }, "Name in the scene, or ''.");
  SceneClass scene(
      m, "Scene",
      "A scene, made by load(), or built from arrays with Scene(). A change takes effect in the "
      "next rendering or measurement. Several threads must not use a scene at the same time.");
  scene.def(py::init([](const api::Point& up, bool is_photometric) {
              return std::make_shared<api::Scene>(api::SceneOptions{up, is_photometric});
            }),
            py::kw_only(), py::arg("up") = api::Point{0, 0, 1}, py::arg("photometric") = true,
            "Makes an empty scene. photometric: light is in cd/m2, cd and lx; otherwise it is in "
            "W/(m2 sr), W/sr and W/m2.");
  bind_facts(scene);
  bind_lights(m, scene);
  bind_materials(m, scene);
  bind_building(scene);
  bind_results(m);
  bind_render(scene);
  bind_annual(m, scene);
  bind_load(m);
}

}  // namespace troffer::bindings
