#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <optional>

#include "python/arguments.h"
#include "python/arrays.h"
#include "python/asked_light.h"
#include "python/bindings.h"

namespace troffer::bindings {

namespace py = pybind11;

namespace {

// The lights of one name. Keeps the scene alive.
struct LightHandle {
  std::shared_ptr<api::Scene> scene;
  std::string name;

  api::LightInfo info() const { return scene->light(name); }
};

void bind_light(py::module_& m) {
  py::class_<LightHandle>(m, "Light", "The lights of one name: a luminaire, a lamp, a sky.")
      .def_readonly("name", &LightHandle::name, "The name.")
      .def_property_readonly(
          "kind", [](const LightHandle& e) { return e.info().kind; },
          "Kind of the first light of this name: 'polygon', 'disk', 'sphere', 'mesh', 'point', "
          "'spot', 'distant', 'environment', 'sky' or 'sun'.")
      .def_property_readonly(
          "count", [](const LightHandle& e) { return e.info().count; },
          "Number of lights in the scene that have this name.")
      .def_property(
          "dimmer", [](const LightHandle& e) { return e.info().dimmer; },
          [](const LightHandle& e, double d) { e.scene->set_dimmer(e.name, d); },
          "Factor on the emitted light, at least 0. 1 is the light of the file.")
      .def_property(
          "radiance", [](const LightHandle& e) { return e.info().radiance; },
          [](const LightHandle& e, const api::Color& c) { e.scene->set_radiance(e.name, c); },
          "(r, g, b) of the first light of this name at dimmer 1. Setting it sets all of them. The "
          "unit is W/(m2 sr), or cd/m2 if Scene.is_photometric; for points and spots W/sr or cd; "
          "for distant lights W/m2 or lx. For images, skies and measured luminaires it is a "
          "factor.")
      .def("__repr__", [](const LightHandle& e) {
        return "<troffer.Light '" + e.name + "' " + e.info().kind + ">";
      });
}

void bind_named_lights(SceneClass& scene) {
  scene
      .def_property_readonly(
          "lights",
          [](const std::shared_ptr<api::Scene>& s) {
            std::vector<LightHandle> all;
            for (const std::string& name : s->light_names()) all.push_back({s, name});
            return all;
          },
          "List of the lights, one item per name.")
      .def(
          "light",
          [](const std::shared_ptr<api::Scene>& s, const std::string& name) {
            s->light(name);
            return LightHandle{s, name};
          },
          py::arg("name"), "The lights of this name; ValueError where there are none.")
      .def("dim", &api::Scene::dim, py::arg("name"), py::arg("factor"),
           "Sets the dimmer of all lights whose names fit the pattern; '*' stands for any "
           "characters.");
}

void bind_lamps(SceneClass& scene) {
  using Intensity = py::handle;
  scene
      .def(
          "add_point_light",
          [](api::Scene& s, const std::string& name, const api::Point& position,
             const Intensity& intensity) {
            s.add_light(api::PointLight{name, position, color_taken(intensity, "intensity")});
          },
          py::arg("name"), py::arg("position"), py::arg("intensity"),
          "Adds a point light. intensity: (r, g, b) or a number in W/sr, or in cd if "
          "Scene.is_photometric.")
      .def(
          "add_spot_light",
          [](api::Scene& s, const std::string& name, const api::Point& position,
             const api::Point& direction, const Intensity& intensity, double inner, double outer) {
            s.add_light(api::SpotLight{name, position, direction,
                                       color_taken(intensity, "intensity"), inner, outer});
          },
          py::arg("name"), py::arg("position"), py::arg("direction"), py::arg("intensity"),
          py::kw_only(), py::arg("inner") = 0.0, py::arg("outer") = 45.0,
          "Adds a spot light. inner, outer: angles from its axis, degrees; the light fades between "
          "them.")
      .def(
          "add_distant_light",
          [](api::Scene& s, const std::string& name, const api::Point& direction,
             const Intensity& irradiance) {
            s.add_light(api::DistantLight{name, direction, color_taken(irradiance, "irradiance")});
          },
          py::arg("name"), py::arg("direction"), py::arg("irradiance"),
          "Adds parallel light. direction: the one in which it travels. irradiance: that of a "
          "surface that faces the light, in W/m2, or in lx if Scene.is_photometric.")
      .def(
          "add_luminaire",
          [](api::Scene& s, const std::string& name, const std::filesystem::path& file,
             const api::Point& position, const std::optional<api::Point>& nadir, double rotation,
             double dimming, const std::optional<double>& lumens,
             const std::optional<double>& kelvin) {
            s.add_light(api::Luminaire{name, file.string(), position, nadir, rotation, dimming,
                                       lumens, kelvin});
          },
          py::arg("name"), py::arg("file"), py::arg("position"), py::kw_only(),
          py::arg("nadir") = py::none(), py::arg("rotation") = 0.0, py::arg("dimming") = 1.0,
          py::arg("lumens") = py::none(), py::arg("kelvin") = py::none(),
          "Adds a measured luminaire (.ies, .ldt). nadir: a direction; straight down by default. "
          "rotation: angle of plane C0 about the nadir, in degrees from the x axis.");
}

void bind_surroundings(SceneClass& scene) {
  scene
      .def(
          "add_environment",
          [](api::Scene& s, const Pixels& image, double scale, double rotation) {
            s.add_environment(image_of(image), scale, rotation);
          },
          py::arg("image"), py::kw_only(), py::arg("scale") = 1.0, py::arg("rotation") = 0.0,
          "Adds the light 'environment' from an image of all directions: linear light (height, "
          "width, 3). The middle column shows the east. Columns to its right follow clockwise, "
          "seen from above.")
      .def(
          "add_sky",
          [](api::Scene& s, const std::string& kind, const std::optional<double>& lux,
             const std::optional<std::pair<double, double>>& sun, double north, double ground) {
            s.add_light(api::Sky{kind, lux, sun, north, ground});
          },
          py::arg("kind") = "overcast", py::kw_only(), py::arg("lux") = py::none(),
          py::arg("sun") = py::none(), py::arg("north") = 0.0, py::arg("ground") = 0.2,
          "Adds the light 'sky', and 'sun' if one is requested. kind: 'even', 'overcast', 'clear', "
          "'cie:1' to 'cie:15'. lux: illuminance of a horizontal plane by the sky alone. sun: "
          "(azimuth, altitude) in degrees, clockwise from north and above the horizon. north: "
          "angle by which north lies clockwise from the file's north, in degrees. ground: "
          "reflectance of the ground.")
      .def(
          "add_light",
          [](api::Scene& s, const py::kwargs& asked) {
            const api::AddedLight light = added_light(asked);
            const py::gil_scoped_release unlocked;
            s.add_light(light);
          },
          add_light_help);
}

}  // namespace

void bind_lights(py::module_& m, SceneClass& scene) {
  bind_light(m);
  bind_named_lights(scene);
  bind_lamps(scene);
  bind_surroundings(scene);
}

}  // namespace troffer::bindings
