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

using api::Material;
using api::MaterialNumber;

struct ModelRow {
  const char* name;
  api::MaterialModel model;
};
constexpr ModelRow models[] = {
    {"matte", api::MaterialModel::matte},           {"plastic", api::MaterialModel::plastic},
    {"metal", api::MaterialModel::metal},           {"mirror", api::MaterialModel::mirror},
    {"principled", api::MaterialModel::principled}, {"glass", api::MaterialModel::glass},
    {"thin_glass", api::MaterialModel::thin_glass},
};

// Returns the default material of a model. Throws UsageError for an unknown name.
Material of_model(const std::string& name) {
  std::string known;
  for (const ModelRow& row : models) {
    if (name == row.name) {
      Material m;
      m.model = row.model;
      const bool is_glass =
          m.model == api::MaterialModel::glass || m.model == api::MaterialModel::thin_glass;
      if (is_glass) m.base_color = {1, 1, 1};
      if (is_glass || m.model == api::MaterialModel::mirror) m.roughness = 0;
      if (m.model == api::MaterialModel::mirror) m.base_color = {0.95F, 0.95F, 0.95F};
      return m;
    }
    known += std::string(known.empty() ? "" : ", ") + row.name;
  }
  throw api::UsageError("there is no model '" + name + "', but " + known);
}

void set_back(Material& m, const py::handle& value) {
  const auto name = taken<std::string>(value, "back");
  if (name == "shown")
    m.back_face = api::BackFace::shown;
  else if (name == "black")
    m.back_face = api::BackFace::black;
  else if (name == "unseen")
    m.back_face = api::BackFace::unseen;
  else
    throw api::UsageError("back is 'shown', 'black' or 'unseen'");
}

using Table = ArgumentTable<Material>;

Table::value_type color(const std::string& name, api::Color Material::*member) {
  return {name, [name, member](Material& m, const py::handle& value) {
            m.*member = color_taken(value, name);
          }};
}

const Table& material_arguments() {
  static const Table table{
      color("base_color", &Material::base_color),
      argument("base_color_texture", &Material::base_color_texture),
      argument("roughness", &Material::roughness),
      argument("roughness_texture", &Material::roughness_texture),
      argument("metallic", &Material::metallic),
      argument("metallic_texture", &Material::metallic_texture),
      argument("ior", &Material::ior),
      argument("specular", &Material::specular),
      color("specular_color", &Material::specular_color),
      argument("transmission", &Material::transmission),
      argument("diffuse_transmission", &Material::diffuse_transmission),
      argument("thin", &Material::is_thin),
      color("absorption", &Material::absorption),
      argument("coat", &Material::coat),
      argument("coat_roughness", &Material::coat_roughness),
      argument("coat_ior", &Material::coat_ior),
      color("sheen_color", &Material::sheen_color),
      argument("sheen_roughness", &Material::sheen_roughness),
      argument("anisotropy", &Material::anisotropy),
      argument("anisotropy_rotation", &Material::anisotropy_rotation),
      argument("normal_texture", &Material::normal_texture),
      argument("normal_scale", &Material::normal_scale),
      argument("alpha_cut", &Material::alpha_cut),
      {"back", set_back},
  };
  return table;
}

MaterialHandle add_material(const std::shared_ptr<api::Scene>& scene, const std::string& name,
                            const std::string& model, const py::kwargs& arguments) {
  Material material = of_model(model);
  for (const auto& [key, value] : arguments) {
    const auto argument_name = py::cast<std::string>(key);
    if (!set_argument(material_arguments(), argument_name, value, material))
      throw py::type_error("add_material() has no argument '" + argument_name + "'");
  }
  return {scene, scene->add_material(name, material)};
}

template <class Class>
void bind_number(Class& c, const char* name, MaterialNumber which, const char* help) {
  c.def_property(
      name, [which](const MaterialHandle& h) { return h.scene->number(h.index, which); },
      [which](const MaterialHandle& h, double v) { h.scene->set_number(h.index, which, v); }, help);
}

void bind_material(py::module_& m) {
  py::class_<MaterialHandle> c(
      m, "Material", "A material. Where a property has a texture the number is a factor on it.");
  c.def_property_readonly("name", &MaterialHandle::name, "The name; materials may share one.")
      .def_property(
          "base_color", [](const MaterialHandle& h) { return h.scene->base_color(h.index); },
          [](const MaterialHandle& h, const api::Color& color) {
            h.scene->set_base_color(h.index, color);
          },
          "Reflectance (r, g, b), linear, 0 to 1.")
      .def("__repr__",
           [](const MaterialHandle& h) { return "<troffer.Material '" + h.name() + "'>"; });
  bind_number(c, "roughness", MaterialNumber::roughness, "0 (a mirror's) to 1.");
  bind_number(c, "metallic", MaterialNumber::metallic, "0 to 1, of glTF's materials.");
  bind_number(c, "ior", MaterialNumber::ior, "Refractive index, 1 to 100.");
  bind_number(c, "specular", MaterialNumber::specular, "Strength of dielectric gloss, 0 to 1.");
  bind_number(c, "transmission", MaterialNumber::transmission,
              "Share of light that passes the surface without being scattered, 0 to 1.");
  bind_number(c, "diffuse_transmission", MaterialNumber::diffuse_transmission,
              "Share of light that passes the surface and leaves it diffusely, 0 to 1.");
  bind_number(c, "coat", MaterialNumber::coat, "Share that wears a clear coat, 0 to 1.");
  bind_number(c, "coat_roughness", MaterialNumber::coat_roughness, "0 to 1.");
}

api::TextureId add_image(api::Scene& s, const py::array& pixels, std::optional<bool> is_srgb,
                         bool is_repeated, bool is_filtered) {
  api::TextureImage image = texture_of(pixels);
  image.is_srgb = is_srgb.value_or(!image.bytes.empty());
  image.is_repeated = is_repeated;
  image.is_filtered = is_filtered;
  return s.add_texture(image);
}

}  // namespace

std::string MaterialHandle::name() const {
  return scene->material_names().at(index);
}

void bind_materials(py::module_& m, SceneClass& scene) {
  bind_material(m);
  py::class_<api::TextureId>(m, "Texture", "An image of a scene: Scene.add_image().");
  scene
      .def_property_readonly(
          "materials",
          [](const std::shared_ptr<api::Scene>& s) {
            std::vector<MaterialHandle> all;
            for (size_t i = 0; i < s->material_names().size(); ++i) all.push_back({s, i});
            return all;
          },
          "List of all materials.")
      .def(
          "material",
          [](const std::shared_ptr<api::Scene>& s, const std::string& name) {
            return MaterialHandle{s, s->material(name)};
          },
          py::arg("name"), "The material of this name; ValueError where there is none, or several.")
      .def("add_image", &add_image, py::arg("pixels"), py::kw_only(), py::arg("srgb") = py::none(),
           py::arg("repeat") = true, py::arg("filtered") = true,
           "Adds an image for materials: (height, width) or (height, width, 1 to 4), uint8 or "
           "linear floats. srgb: true if bytes have the sRGB curve, which is the default; use "
           "False for roughness and normals.")
      .def(
          "add_material", &add_material, py::arg("name"), py::arg("model") = "matte",
          "Adds a material. model: 'matte', 'plastic', 'metal', 'mirror', 'principled', 'glass' or "
          "'thin_glass'. Keywords: base_color, roughness, metallic, ior, specular, specular_color, "
          "transmission, diffuse_transmission, thin, absorption, coat, coat_roughness, coat_ior, "
          "sheen_color, sheen_roughness, anisotropy, anisotropy_rotation, normal_scale, alpha_cut, "
          "back ('shown', 'black', 'unseen'). Keywords that take a result of add_image(): "
          "base_color_texture, roughness_texture, metallic_texture, normal_texture.");
}

}  // namespace troffer::bindings
