// Scene: adds and changes materials and textures.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "api/scene_impl.h"
#include "api/values.h"
#include "base/error.h"
#include "base/units.h"
#include "troffer/scene.h"

namespace troffer::api {

namespace {

constexpr double least_ior = 1, most_ior = 100;
constexpr int widest_texture = 1 << 16;

MaterialKind kind_of(MaterialModel model) {
  switch (model) {
    case MaterialModel::matte:
      return MaterialKind::diffuse;
    case MaterialModel::plastic:
      return MaterialKind::coated_diffuse;
    case MaterialModel::metal:
    case MaterialModel::mirror:
      return MaterialKind::conductor;
    case MaterialModel::principled:
      return MaterialKind::metallic_roughness;
    case MaterialModel::glass:
    case MaterialModel::thin_glass:
      return MaterialKind::dielectric;
  }
  throw UsageError("there is no such material model");
}

BackFaces back_faces_of(BackFace face) {
  return face == BackFace::unseen  ? BackFaces::unseen
         : face == BackFace::black ? BackFaces::black
                                   : BackFaces::shown;
}

// One row per number that may change: its name and its member.
struct NumberRow {
  MaterialNumber which;
  const char* name;
  FloatInput troffer::Material::*input;  // null: ior
};
constexpr NumberRow number_rows[] = {
    {MaterialNumber::roughness, "roughness", &troffer::Material::roughness},
    {MaterialNumber::metallic, "metallic", &troffer::Material::metallic},
    {MaterialNumber::ior, "ior", nullptr},
    {MaterialNumber::specular, "specular", &troffer::Material::specular},
    {MaterialNumber::transmission, "transmission", &troffer::Material::transmission},
    {MaterialNumber::diffuse_transmission, "diffuse_transmission",
     &troffer::Material::diffuse_transmission},
    {MaterialNumber::coat, "coat", &troffer::Material::coat},
    {MaterialNumber::coat_roughness, "coat_roughness", &troffer::Material::coat_roughness},
};

const NumberRow& row_of(MaterialNumber which) {
  for (const NumberRow& r : number_rows)
    if (r.which == which) return r;
  throw UsageError("there is no such number of a material");
}

// Checks a public Material and converts it. Messages name the material.
class MaterialReader {
 public:
  MaterialReader(const Scene::Impl& scene, const std::string& name, const Material& from)
      : scene_(scene), owner_("material '" + name + "': "), from_(from) {
    made_.name = name;
    made_.kind = kind_of(from.model);
  }

  troffer::Material read() {
    made_.base_color = {share(from_.base_color, owner_ + "base_color"),
                        texture(from_.base_color_texture)};
    read_gloss();
    read_layers();
    made_.normal_texture = texture(from_.normal_texture);
    if (!std::isfinite(from_.normal_scale)) throw UsageError(owner_ + "normal_scale is not finite");
    made_.normal_scale = float(from_.normal_scale);
    made_.back_faces = back_faces_of(from_.back_face);
    if (from_.alpha_cut) {
      made_.is_alpha_masked = true;
      made_.alpha.texture = made_.base_color.texture;
      made_.alpha_cutoff = unit(*from_.alpha_cut, "alpha_cut");
    }
    return made_;
  }

 private:
  float unit(double value, const char* what) { return float(in_range(value, 0, 1, owner_ + what)); }
  float index(double value, const char* what) {
    return float(in_range(value, least_ior, most_ior, owner_ + what));
  }
  int32_t texture(TextureId id) const { return scene_.texture_for(id); }

  void read_gloss() {
    const bool is_smooth =
        from_.model == MaterialModel::mirror || from_.model == MaterialModel::thin_glass;
    made_.roughness_meaning = RoughnessMeaning::alpha_is_square;
    made_.roughness = {is_smooth ? 0.0f : unit(from_.roughness, "roughness"),
                       is_smooth ? no_texture : texture(from_.roughness_texture), 1};
    made_.metallic = {unit(from_.metallic, "metallic"), texture(from_.metallic_texture), 2};
    made_.is_reflectance = made_.kind == MaterialKind::conductor;
    made_.ior = index(from_.ior, "ior");
    made_.specular.value = unit(from_.specular, "specular");
    made_.specular_color.value = share(from_.specular_color, owner_ + "specular_color");
    made_.anisotropy.value = unit(from_.anisotropy, "anisotropy");
    if (!std::isfinite(from_.anisotropy_rotation))
      throw UsageError(owner_ + "anisotropy_rotation is not finite");
    made_.anisotropy_rotation_rad = float(rad_from_deg(from_.anisotropy_rotation));
  }

  void read_layers() {
    made_.transmission.value = unit(from_.transmission, "transmission");
    made_.diffuse_transmission.value = unit(from_.diffuse_transmission, "diffuse_transmission");
    made_.is_thin = from_.model == MaterialModel::thin_glass ||
                    (from_.model == MaterialModel::principled && from_.is_thin);
    made_.absorption = emitted(from_.absorption, owner_ + "absorption");
    made_.coat.value = unit(from_.coat, "coat");
    made_.coat_roughness.value = unit(from_.coat_roughness, "coat_roughness");
    made_.coat_ior = index(from_.coat_ior, "coat_ior");
    made_.sheen_color.value = share(from_.sheen_color, owner_ + "sheen_color");
    made_.sheen_roughness.value = unit(from_.sheen_roughness, "sheen_roughness");
  }

  const Scene::Impl& scene_;
  const std::string owner_;
  const Material& from_;
  troffer::Material made_;
};

void check_texels(const TextureImage& image) {
  if (image.width < 1 || image.height < 1 || image.width > widest_texture ||
      image.height > widest_texture)
    throw UsageError("a texture has between 1 and 65536 rows and columns");
  if (image.channels < 1 || image.channels > 4)
    throw UsageError("a texture has between 1 and 4 channels");
  const size_t texels = size_t(image.width) * size_t(image.height) * size_t(image.channels);
  if (image.bytes.empty() == image.floats.empty())
    throw UsageError("a texture has either bytes or floats");
  const size_t given = std::max(image.bytes.size(), image.floats.size());
  if (given != texels)
    throw UsageError(fmt::format("a texture of {} x {} with {} channels has {} values, not {}",
                                 image.width, image.height, image.channels, texels, given));
  if (!std::all_of(image.floats.begin(), image.floats.end(),
                   [](float v) { return std::isfinite(v); }))
    throw UsageError("a texture has values that are not finite");
}

Material of_model(MaterialModel model, const Color& color, double roughness) {
  Material m;
  m.model = model;
  m.base_color = color;
  m.roughness = roughness;
  return m;
}

}  // namespace

Material Material::matte(const Color& reflectance) {
  return of_model(MaterialModel::matte, reflectance, 0.5);
}
Material Material::plastic(const Color& reflectance, double roughness, double ior) {
  Material m = of_model(MaterialModel::plastic, reflectance, roughness);
  m.ior = ior;
  return m;
}
Material Material::metal(const Color& reflectance, double roughness) {
  return of_model(MaterialModel::metal, reflectance, roughness);
}
Material Material::mirror(const Color& reflectance) {
  return of_model(MaterialModel::mirror, reflectance, 0);
}
Material Material::principled(const Color& base_color, double roughness, double metallic) {
  Material m = of_model(MaterialModel::principled, base_color, roughness);
  m.metallic = metallic;
  return m;
}
Material Material::glass(double ior, double roughness) {
  Material m = of_model(MaterialModel::glass, {1, 1, 1}, roughness);
  m.ior = ior;
  return m;
}
Material Material::thin_glass(double ior) {
  Material m = of_model(MaterialModel::thin_glass, {1, 1, 1}, 0);
  m.ior = ior;
  return m;
}

int32_t Scene::Impl::texture_for(TextureId id) const {
  if (id.index == -1) return no_texture;
  if (id.index < -1 || size_t(id.index) >= script.scene().textures.size())
    throw UsageError(fmt::format("there is no texture {}", id.index));
  return id.index;
}

TextureId Scene::add_texture(const TextureImage& image) {
  check_texels(image);
  Texture t;
  t.kind = TextureKind::image;
  t.width = image.width;
  t.height = image.height;
  t.channels = image.channels;
  t.texels8 = image.bytes;
  t.texels_float = image.floats;
  t.is_srgb = image.is_srgb && !image.bytes.empty();
  t.is_filtered = image.is_filtered;
  t.wrap_u = t.wrap_v = image.is_repeated ? WrapMode::repeat : WrapMode::clamp;
  std::vector<Texture>& all = impl_->script.change().textures;
  t.name = fmt::format("texture{}", all.size());
  all.push_back(std::move(t));
  return {int(all.size() - 1)};
}

std::size_t Scene::add_material(const std::string& name, const Material& material) {
  const std::vector<troffer::Material>& all = impl_->script.scene().materials;
  if (name.empty()) throw UsageError("a material has a name");
  for (const troffer::Material& m : all)
    if (m.name == name) throw UsageError("there is a material '" + name + "' already");
  troffer::Material made = MaterialReader(*impl_, name, material).read();
  impl_->script.change().materials.push_back(std::move(made));
  return all.size() - 1;
}

std::vector<std::string> Scene::material_names() const {
  std::vector<std::string> names;
  for (const troffer::Material& m : impl_->script.scene().materials) names.push_back(m.name);
  return names;
}

std::size_t Scene::material(const std::string& name) const {
  return impl_->script.material_named(name);
}

static const troffer::Material& checked_material(const troffer::Scene& scene, std::size_t number) {
  if (number >= scene.materials.size())
    throw UsageError(fmt::format("there is no material {} of {}", number, scene.materials.size()));
  return scene.materials[number];
}

Color Scene::base_color(std::size_t material) const {
  return color(checked_material(impl_->script.scene(), material).base_color.value);
}

void Scene::set_base_color(std::size_t material, const Color& color) {
  checked_material(impl_->script.scene(), material);
  const Rgb checked = share(color, "base_color");
  impl_->script.change().materials[material].base_color.value = checked;
}

double Scene::number(std::size_t material, MaterialNumber which) const {
  const troffer::Material& m = checked_material(impl_->script.scene(), material);
  const NumberRow& row = row_of(which);
  return double(row.input != nullptr ? (m.*row.input).value : m.ior);
}

void Scene::set_number(std::size_t material, MaterialNumber which, double value) {
  checked_material(impl_->script.scene(), material);
  const NumberRow& row = row_of(which);
  const bool is_ior = row.input == nullptr;
  const auto checked = float(is_ior ? in_range(value, least_ior, most_ior, row.name)
                                    : in_range(value, 0, 1, row.name));
  troffer::Material& m = impl_->script.change().materials[material];
  (is_ior ? m.ior : (m.*row.input).value) = checked;
}

}  // namespace troffer::api
