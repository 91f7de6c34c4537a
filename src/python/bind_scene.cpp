#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "base/error.h"
#include "python/asked_light.h"
#include "python/bindings.h"
#include "python/script_scene.h"
#include "render/camera.h"
#include "scene/orientation.h"

namespace troffer {

namespace py = pybind11;

namespace {

using Triple = std::array<float, 3>;

Triple triple(Rgb c) {
  return {c.r, c.g, c.b};
}
Rgb rgb(const Triple& c) {
  return {c[0], c[1], c[2]};
}
Vec3d vec(const std::array<double, 3>& v) {
  return {v[0], v[1], v[2]};
}

// The lights of one name; the scene stays alive with the handle.
struct LightHandle {
  std::shared_ptr<ScriptScene> scene;
  std::string name;

  const Light& first() const { return scene->scene().lights[scene->lights_named(name).front()]; }
};

struct MaterialHandle {
  std::shared_ptr<ScriptScene> scene;
  size_t index;

  const Material& get() const { return scene->scene().materials[index]; }
  Material& change() const { return scene->change().materials[index]; }
};

float in_range(double value, double least, double most, const char* what) {
  if (!(value >= least && value <= most))
    throw UsageError(std::string(what) + " must lie between " +
                     py::str(py::float_(least)).cast<std::string>() + " and " +
                     py::str(py::float_(most)).cast<std::string>());
  return float(value);
}

void bind_lights(py::module_& m) {
  py::class_<LightHandle>(m, "Light", "The lights of one name: a luminaire, a lamp, a sky.")
      .def_readonly("name", &LightHandle::name)
      .def_property_readonly(
          "kind", [](const LightHandle& e) { return name_of(e.first().kind); },
          "Kind of the first one: 'polygon', 'disk', 'sphere', 'mesh', 'point', 'spot', 'distant', "
          "'environment', 'sky' or 'sun'.")
      .def_property_readonly(
          "count", [](const LightHandle& e) { return e.scene->lights_named(e.name).size(); },
          "Number of lights of the scene with this name.")
      .def_property(
          "dimmer", [](const LightHandle& e) { return e.scene->dimmer(e.name); },
          [](const LightHandle& e, double d) { e.scene->set_dimmer(e.name, d); },
          "Factor on their light, at least 0; 1 leaves it as in the file.")
      .def_property(
          "radiance", [](const LightHandle& e) { return triple(e.scene->radiance(e.name)); },
          [](const LightHandle& e, const Triple& c) { e.scene->set_radiance(e.name, rgb(c)); },
          "(r, g, b), undimmed, of the first one; setting it sets all. W/(m2 sr), or cd/m2 where "
          "Scene.is_photometric; of points and spots W/sr or cd, of distant lights W/m2 or lx; of "
          "images, skies and measured luminaires a factor.")
      .def("__repr__", [](const LightHandle& e) {
        return "<troffer.Light '" + e.name + "' " + name_of(e.first().kind) + ">";
      });
}

void bind_materials(py::module_& m) {
  py::class_<MaterialHandle>(
      m, "Material", "A material. If a property has a texture, the number is a factor on it.")
      .def_property_readonly("name", [](const MaterialHandle& h) { return h.get().name; })
      .def_property(
          "base_color", [](const MaterialHandle& h) { return triple(h.get().base_color.value); },
          [](const MaterialHandle& h, const Triple& c) {
            for (const float v : c) in_range(v, 0, 1, "base_color");
            h.change().base_color.value = rgb(c);
          },
          "(r, g, b), linear, 0 to 1: reflectance.")
      .def_property(
          "roughness", [](const MaterialHandle& h) { return h.get().roughness.value; },
          [](const MaterialHandle& h, double v) {
            const float checked = in_range(v, 0, 1, "roughness");
            h.change().roughness.value = checked;
          },
          "0 (mirror) to 1.")
      .def_property(
          "metallic", [](const MaterialHandle& h) { return h.get().metallic.value; },
          [](const MaterialHandle& h, double v) {
            const float checked = in_range(v, 0, 1, "metallic");
            h.change().metallic.value = checked;
          },
          "0 to 1, for materials of glTF.")
      .def("__repr__",
           [](const MaterialHandle& h) { return "<troffer.Material '" + h.get().name + "'>"; });
}

std::vector<std::string> warnings(const ScriptScene& s) {
  std::vector<std::string> texts;
  for (const Warning& w : s.scene().warnings.entries()) texts.push_back(w.text);
  return texts;
}

SkyRequest sky_request(const std::string& kind, const std::optional<double>& lux,
                       const std::optional<std::pair<double, double>>& sun, double ground) {
  SkyRequest r;
  r.kind = kind == "even" ? SkyKind::even : SkyKind::cie;
  r.cie_type = kind == "overcast" ? 1 : kind == "clear" ? 12 : 0;
  for (int type = 1; type <= 15; ++type)
    if (kind == "cie:" + std::to_string(type)) r.cie_type = type;
  if (r.kind == SkyKind::cie && r.cie_type == 0)
    throw UsageError("a sky must be even, overcast, clear or cie:1 to cie:15");
  if (lux) r.diffuse_lx = in_range(*lux, 0, 1e9, "lux");
  if (sun) {
    r.sun = SunRequest{};
    if (!std::isfinite(sun->first)) throw UsageError("the sun's azimuth must be a finite number");
    r.sun->azimuth_deg = sun->first;
    r.sun->altitude_deg = in_range(sun->second, 0, 90, "the sun's altitude");
  } else if (needs_sun(r)) {
    throw UsageError("this sky depends on the sun: sun=(azimuth, altitude)");
  }
  r.ground_reflectance = in_range(ground, 0, 1, "ground");
  return r;
}

using SceneClass = py::class_<ScriptScene, std::shared_ptr<ScriptScene>>;

void bind_parts(SceneClass& scene) {
  scene
      .def_property_readonly(
          "lights",
          [](const std::shared_ptr<ScriptScene>& s) {
            std::vector<LightHandle> all;
            for (const std::string& name : s->light_names()) all.push_back({s, name});
            return all;
          },
          "Lights, one for each name.")
      .def(
          "light",
          [](const std::shared_ptr<ScriptScene>& s, const std::string& name) {
            s->lights_named(name);
            return LightHandle{s, name};
          },
          py::arg("name"), "The lights of this name; ValueError if there are none.")
      .def_property_readonly(
          "materials",
          [](const std::shared_ptr<ScriptScene>& s) {
            std::vector<MaterialHandle> all;
            for (size_t i = 0; i < s->scene().materials.size(); ++i) all.push_back({s, i});
            return all;
          },
          "All materials.")
      .def(
          "material",
          [](const std::shared_ptr<ScriptScene>& s, const std::string& name) {
            return MaterialHandle{s, s->material_named(name)};
          },
          py::arg("name"), "The material of this name; ValueError if there is none or several.")
      .def(
          "add_sky",
          [](ScriptScene& s, const std::string& kind, const std::optional<double>& lux,
             const std::optional<std::pair<double, double>>& sun, double north, double ground) {
            s.add_sky(sky_request(kind, lux, sun, ground), decide_up(s.scene()).up, north);
          },
          py::arg("kind") = "overcast", py::kw_only(), py::arg("lux") = py::none(),
          py::arg("sun") = py::none(), py::arg("north") = 0.0, py::arg("ground") = 0.2,
          "Adds the light 'sky' (and 'sun'). kind: 'even', 'overcast', 'clear', 'cie:1' to "
          "'cie:15'; lux: illuminance of a horizontal plane by the sky; sun: (azimuth, altitude) "
          "in degrees, clockwise from north, above the horizon; north: degrees clockwise from the "
          "file's north; ground: its reflectance.");
}

void bind_added_light(SceneClass& scene) {
  scene.def(
      "add_light",
      [](ScriptScene& s, const py::kwargs& asked) {
        const DaylightOptions options = daylight_options(asked);
        const py::gil_scoped_release unlocked;
        try {
          s.add_light(options);
        } catch (const UsageError& e) {
          throw UsageError(in_script_words(e.what()));
        }
      },
      add_light_help);
}

void bind_facts(SceneClass& scene) {
  scene.def_property_readonly("file", [](const ScriptScene& s) { return s.scene().file; })
      .def_property_readonly("warnings", &warnings, "Warnings about the file.")
      .def_property_readonly(
          "is_photometric", [](const ScriptScene& s) { return s.scene().is_photometric; },
          "True if light is in cd/m2 (glTF), false if it is in W/(m2 sr).")
      .def_property_readonly("triangles",
                             [](const ScriptScene& s) { return triangle_count(s.scene()); })
      .def_property_readonly(
          "cameras",
          [](const ScriptScene& s) {
            std::vector<std::string> names;
            for (const Camera& c : s.scene().cameras) names.push_back(c.name);
            return names;
          },
          "Names of the cameras.")
      .def_property_readonly(
          "bounds",
          [](const ScriptScene& s) {
            const Boxd b = bounds_in_file(s.scene());
            return py::make_tuple(py::make_tuple(b.lower.x, b.lower.y, b.lower.z),
                                  py::make_tuple(b.upper.x, b.upper.y, b.upper.z));
          },
          "((x, y, z), (x, y, z)): the lower and the upper corner, metres.")
      .def("__repr__",
           [](const ScriptScene& s) { return "<troffer.Scene '" + s.scene().file + "'>"; });
}

}  // namespace

void bind_scene(py::module_& m) {
  py::class_<Camera>(m, "Camera", "A camera, made by look_at() or Scene.camera().")
      .def_readonly("name", &Camera::name);
  bind_lights(m);
  bind_materials(m);
  SceneClass scene(m, "Scene",
                   "A scene, made by load(). Changes take effect with the next rendering or "
                   "measurement. Not for use from several threads at once.");
  bind_facts(scene);
  bind_parts(scene);
  bind_added_light(scene);
  scene
      .def("camera", &ScriptScene::camera, py::arg("name") = "",
           "The camera of this name; else the first one, or one that frames the scene.")
      .def(
          "look_at",
          [](const ScriptScene& s, const std::array<double, 3>& eye,
             const std::array<double, 3>& target, const std::optional<std::array<double, 3>>& up,
             double fov) {
            return look_at(Vec3(vec(eye) - s.scene().origin), Vec3(vec(target) - s.scene().origin),
                           up ? Vec3(vec(*up)) : decide_up(s.scene()).up,
                           in_range(fov, 0.01, 179, "fov"));
          },
          py::arg("eye"), py::arg("target"), py::kw_only(), py::arg("up") = py::none(),
          py::arg("fov") = 60.0,
          "A camera at `eye` that looks at `target` (x, y, z in metres); fov in degrees over the "
          "picture's shorter side.");
  m.def(
      "load",
      [](const std::filesystem::path& file, const std::optional<std::string>& variant,
         const std::optional<double>& time, const std::optional<std::string>& animation) {
        const py::gil_scoped_release unlocked;
        return std::make_shared<ScriptScene>(
            file.string(),
            ImportOptions{
                .variant = variant, .time = time, .animation = animation, .progress = {}});
      },
      py::arg("file"), py::kw_only(), py::arg("variant") = py::none(), py::arg("time") = py::none(),
      py::arg("animation") = py::none(),
      "Loads a scene from a path (str or os.PathLike): .gltf .glb .pbrt .obj .stl .ply .xml "
      "(Mitsuba) or .rad. variant: of glTF's materials; "
      "time: "
      "seconds into the animation. Raises InputError.");
}

}  // namespace troffer
