#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <optional>

#include "python/arguments.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/material_handle.h"

namespace troffer::bindings {

namespace py = pybind11;

namespace {

// Accepts None, a name or a Material of the scene.
std::string material_name(const py::object& value) {
  if (value.is_none()) return "";
  if (py::isinstance<MaterialHandle>(value)) return value.cast<const MaterialHandle&>().name();
  return taken<std::string>(value, "material");
}

std::optional<api::Emission> emission_of(const py::object& radiance, bool is_two_sided,
                                         const std::optional<api::TextureId>& texture) {
  if (radiance.is_none()) return std::nullopt;
  api::Emission e;
  e.radiance = color_taken(radiance, "emission");
  e.is_two_sided = is_two_sided;
  if (texture) e.texture = *texture;
  return e;
}

// Accepts None, or an affine matrix (3, 4) or (4, 4).
api::Transform transform_of(const py::object& value) {
  if (value.is_none()) return api::identity;
  const auto rows = rows_of<double, 4>(value, "transform");
  const bool is_affine =
      rows.size() == 3 || (rows.size() == 4 && rows[3] == std::array<double, 4>{0, 0, 0, 1});
  if (!is_affine) throw api::UsageError("transform: an affine matrix of shape (3, 4) or (4, 4)");
  return {rows[0], rows[1], rows[2]};
}

struct Shape {
  py::object material, emission;
  bool is_two_sided = false;
  std::optional<api::TextureId> texture;
};

void add_mesh(api::Scene& s, const py::object& positions, const py::object& triangles,
              const py::object& normals, const py::object& uvs, const std::string& name,
              const py::object& transform, const Shape& shape) {
  api::MeshData mesh;
  mesh.name = name;
  mesh.positions = rows_of<double, 3>(positions, "positions");
  mesh.triangles = triangles_of(triangles);
  mesh.normals = rows_of<float, 3>(normals, "normals");
  mesh.uvs = rows_of<float, 2>(uvs, "uvs");
  mesh.material = material_name(shape.material);
  mesh.transform = transform_of(transform);
  mesh.emission = emission_of(shape.emission, shape.is_two_sided, shape.texture);
  const py::gil_scoped_release unlocked;
  s.add_mesh(mesh);
}

void bind_shapes(SceneClass& scene) {
  scene
      .def(
          "add_mesh",
          [](api::Scene& s, const py::object& positions, const py::object& triangles,
             const py::object& normals, const py::object& uvs, const py::object& material,
             const py::object& emission, bool is_two_sided,
             const std::optional<api::TextureId>& texture, const std::string& name,
             const py::object& transform) {
            add_mesh(s, positions, triangles, normals, uvs, name, transform,
                     {material, emission, is_two_sided, texture});
          },
          py::arg("positions"), py::arg("triangles"), py::arg("normals") = py::none(),
          py::arg("uvs") = py::none(), py::kw_only(), py::arg("material") = py::none(),
          py::arg("emission") = py::none(), py::arg("two_sided") = false,
          py::arg("emission_texture") = py::none(), py::arg("name") = "",
          py::arg("transform") = py::none(),
          "Adds a mesh: positions (n, 3) in metres, triangles (m, 3) of vertex indices from 0, "
          "normals (n, 3), uvs (n, 2). material: a name or a Material; grey by default. emission: "
          "(r, g, b) or a number; the front alone emits unless two_sided is true, and the light "
          "takes the mesh's name. The front is the side that the normals point to. Without normals "
          "it is the side from which the vertices run counterclockwise. transform: (3, 4) or (4, "
          "4).")
      .def(
          "add_sphere",
          [](api::Scene& s, const api::Point& centre, double radius, const py::object& material,
             const py::object& emission, const std::string& name) {
            s.add_sphere({name, centre, radius, material_name(material),
                          emission_of(emission, false, std::nullopt)});
          },
          py::arg("centre"), py::arg("radius"), py::kw_only(), py::arg("material") = py::none(),
          py::arg("emission") = py::none(), py::arg("name") = "",
          "Adds a sphere. Its front is the outside. The arguments are those of add_mesh().");
}

api::LookAt view_of_arguments(const api::Point& eye, const api::Point& target,
                              const std::optional<api::Point>& up, double fov, double lens_radius,
                              double focal_distance) {
  return {eye, target, up, fov, lens_radius, focal_distance};
}

}  // namespace

void bind_building(SceneClass& scene) {
  bind_shapes(scene);
  scene
      .def(
          "add_camera",
          [](api::Scene& s, const std::string& name, const api::Point& eye,
             const api::Point& target, const std::optional<api::Point>& up, double fov,
             double lens_radius, double focal_distance) {
            s.add_camera(name,
                         view_of_arguments(eye, target, up, fov, lens_radius, focal_distance));
          },
          py::arg("name"), py::arg("eye"), py::arg("target"), py::kw_only(),
          py::arg("up") = py::none(), py::arg("fov") = 60.0, py::arg("lens_radius") = 0.0,
          py::arg("focal_distance") = 0.0, "Adds a camera under a name; arguments as of look_at().")
      .def(
          "look_at",
          [](const api::Scene& s, const api::Point& eye, const api::Point& target,
             const std::optional<api::Point>& up, double fov, double lens_radius,
             double focal_distance) {
            return s.look_at(view_of_arguments(eye, target, up, fov, lens_radius, focal_distance));
          },
          py::arg("eye"), py::arg("target"), py::kw_only(), py::arg("up") = py::none(),
          py::arg("fov") = 60.0, py::arg("lens_radius") = 0.0, py::arg("focal_distance") = 0.0,
          "Returns a camera at `eye` that looks at `target` (x, y, z in metres). fov: degrees over "
          "the picture's shorter side. lens_radius: metres; 0 makes everything sharp. "
          "focal_distance: metres; 0 focuses on the target.");
}

}  // namespace troffer::bindings
