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
          "The path that load() was given; '' for a built scene.")
      .def_property_readonly("warnings", &api::Scene::warnings,
                             "What was odd in the file, in words.")
      .def_property_readonly("is_photometric", &api::Scene::is_photometric,
                             "Light is in cd/m2 (glTF), not in W/(m2 sr).")
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
          "((x, y, z), (x, y, z)): the lower and the upper corner, metres.")
      .def("camera", &api::Scene::camera, py::arg("name") = "",
           "The camera of this name; else the first one, or one that frames the scene.")
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
      "(Mitsuba), .rad or .hbjson. variant: of glTF's materials; time: seconds into the animation; "
      "emission_scale: factor on what surfaces of the file emit; baked: show the light that "
      "`troffer bake` wrote. Raises InputError.");
}

}  // namespace

void bind_scene(py::module_& m) {
  py::class_<api::Camera>(m, "Camera", "What a picture is seen from: look_at(), Scene.camera().")
      .def_property_readonly(
          "name", [](const api::Camera& c) { return c.name(); }, "Its name in the scene, or ''.");
  SceneClass scene(m, "Scene",
                   "A scene: load(), or Scene() to build one from arrays. What is changed counts "
                   "from the next rendering or measurement on. Not for use from several threads at "
                   "once.");
  scene.def(py::init([](const api::Point& up, bool is_photometric) {
              return std::make_shared<api::Scene>(api::SceneOptions{up, is_photometric});
            }),
            py::kw_only(), py::arg("up") = api::Point{0, 0, 1}, py::arg("photometric") = true,
            "An empty scene. photometric: light is in cd/m2, cd and lx, else in W/(m2 sr), W/sr "
            "and W/m2.");
  bind_facts(scene);
  bind_lights(m, scene);
  bind_materials(m, scene);
  bind_building(scene);
  bind_results(m);
  bind_render(scene);
  bind_load(m);
}

}  // namespace troffer::bindings
