#include "import/mitsuba/mitsuba_bsdf.h"

#include <algorithm>
#include <cmath>

#include "base/coat.h"
#include "base/facets.h"
#include "import/anisotropic_roughness.h"
#include "import/measured_bsdf.h"
#include "import/mitsuba/mitsuba_values.h"

namespace troffer {

namespace {

constexpr int max_bsdf_depth = 16;
constexpr float default_alpha = 0.1f;

bool is_texture(const ColorInput& c) {
  return c.texture >= 0;
}

// The material with a black back.
Material one_sided(Material m) {
  m.back_faces = BackFaces::black;
  return m;
}

float mean_of(const ColorInput& c) {
  return average(c.value);
}

}  // namespace

void MitsubaBsdfs::approximate(const MitsubaNode& node, const std::string& how) {
  scene_.warnings.add("bsdf \"" + shortened(node.type) + "\" is approximated: " + how);
}

uint32_t MitsubaBsdfs::default_index(bool is_emitting) {
  std::optional<uint32_t>& index = is_emitting ? black_ : grey_;
  if (!index) {
    Material m;
    m.name = is_emitting ? "black" : "default";
    if (is_emitting) m.base_color.value = Rgb{0};
    m.back_faces = BackFaces::black;
    index = uint32_t(scene_.materials.size());
    scene_.materials.push_back(std::move(m));
  }
  return *index;
}

uint32_t MitsubaBsdfs::invisible_index() {
  if (!nothing_) {
    Material m;
    m.name = "null";
    m.kind = MaterialKind::dielectric;
    m.base_color.value = Rgb{1};
    m.is_thin = true;
    m.ior = 1;
    nothing_ = uint32_t(scene_.materials.size());
    scene_.materials.push_back(std::move(m));
  }
  return *nothing_;
}

std::optional<uint32_t> MitsubaBsdfs::index_of(const MitsubaNode& given) {
  const MitsubaNode& node = tree_.resolved(given);
  for (const MitsubaAttributes* a :
       {static_cast<const MitsubaAttributes*>(nullptr), textures_.attributes()})
    if (const auto found = made_.find({&node, a}); found != made_.end()) return found->second;
  const size_t uses = textures_.attribute_uses();
  std::optional<Material> m = convert(node);
  std::optional<uint32_t> index;
  if (m) {
    m->name = node.id;
    index = uint32_t(scene_.materials.size());
    scene_.materials.push_back(std::move(*m));
  }
  const bool shows_attributes = textures_.attribute_uses() > uses;
  return made_[{&node, shows_attributes ? textures_.attributes() : nullptr}] = index;
}

// Converts the first bsdf inside another one. Returns nothing if it is null.
std::optional<Material> MitsubaBsdfs::nested(const MitsubaNode& node) {
  for (const MitsubaNode* child : node.children) {
    const MitsubaNode& inner = tree_.resolved(*child);
    if (inner.tag != "bsdf") continue;
    child->is_used = true;
    return convert(inner);
  }
  node.place.fail("bsdf \"" + shortened(node.type) + "\" has no bsdf in it");
}

void MitsubaBsdfs::read_alpha(const MitsubaNode& node, Material& m) {
  m.roughness_meaning = RoughnessMeaning::alpha;
  if (find_parameter(node, "alpha_u") || find_parameter(node, "alpha_v")) {
    const FloatInput u = textures_.real(node, {"alpha_u"}, default_alpha);
    const FloatInput v = textures_.real(node, {"alpha_v"}, default_alpha);
    const bool is_metal = m.kind == MaterialKind::conductor;
    if (!is_metal || !set_anisotropic_roughness(scene_, m, u, v)) {
      m.roughness = u;
      m.roughness.value = std::sqrt(u.value * v.value);
      if (u.value != v.value || u.texture != v.texture)
        approximate(node, "different roughness along u and v as its geometric mean");
    }
  } else {
    m.roughness = textures_.real(node, {"alpha"}, default_alpha);
  }
  const std::string distribution = get_text(node, "distribution", "beckmann");
  m.facets = distribution == "ggx" ? FacetModel::single_ggx : FacetModel::single_beckmann;
  if (distribution != "ggx" && distribution != "beckmann")
    approximate(node, "microfacets \"" + shortened(distribution) + "\" as Beckmann's");
  get_flag(node, "sample_visible", true);
}

Material MitsubaBsdfs::diffuse(const MitsubaNode& node) {
  Material m;
  if (node.type == "roughdiffuse") {
    textures_.real(node, {"alpha"}, 0);
    find_parameter(node, "use_fast_approx");
    approximate(node, "without its roughness");
  }
  m.base_color = textures_.color(node, {"reflectance", "diffuse_reflectance"}, Rgb{0.5f});
  return m;
}

Material MitsubaBsdfs::conductor(const MitsubaNode& node) {
  Material m;
  m.kind = MaterialKind::conductor;
  if (node.type == "roughconductor") read_alpha(node, m);
  const ColorInput scale = textures_.color(node, {"specular_reflectance"}, Rgb{1});
  const MitsubaNode *eta = find_parameter(node, "eta"), *k = find_parameter(node, "k");
  const std::string name = get_text(node, "material", tree_.is_legacy() && !eta ? "Cu" : "none");
  const double outside =
      find_parameter(node, "ext_eta") ? index_of_refraction(node, "ext_eta", "air") : 1;
  if (eta || k) {
    m.eta = eta ? metal_index_of(tree_.resolved(*eta), tree_.folder()) : Rgb{0};
    m.k = k ? metal_index_of(tree_.resolved(*k), tree_.folder()) : Rgb{1};
  } else if (const auto known = mitsuba_metal(name)) {
    m.eta = known->eta;
    m.k = known->k;
  } else if (const auto other = named_metal("metal-" + name + "-eta")) {
    m.eta = *other;
    m.k = *named_metal("metal-" + name + "-k");
  } else {
    // eta 0 and k 1 reflect all light
    m.is_reflectance = true;
    m.base_color = scale;
    if (name != "none") {
      m.base_color.value *= Rgb{0.6f};
      approximate(node, "the metal \"" + shortened(name) + "\" is not known; reflectance 0.6");
    }
    return m;
  }
  m.eta = m.eta / float(outside);
  m.k = m.k / float(outside);
  m.specular_color = scale;
  return m;
}

Material MitsubaBsdfs::dielectric(const MitsubaNode& node) {
  Material m;
  m.kind = MaterialKind::dielectric;
  m.is_thin = node.type == "thindielectric";
  if (node.type == "roughdielectric") read_alpha(node, m);
  m.ior = float(index_of_refraction(node, "int_ior", "bk7") /
                index_of_refraction(node, "ext_ior", "air"));
  m.specular_color = textures_.color(node, {"specular_reflectance"}, Rgb{1});
  m.base_color = textures_.color(node, {"specular_transmittance"}, Rgb{1});
  return m;
}

// Mitsuba's default treats every inner reflection as if the base were white: ρ / (1 - F), with F
// the coat's mean reflectance from inside. With `nonlinear` it is ρ / (1 - ρF), as in our coat. A
// base colour of ρ / (1 - F + ρF) turns ours into Mitsuba's default. Textured roughness, which
// Mitsuba 3 does not have, uses FacetModel::balanced.
Material MitsubaBsdfs::plastic(const MitsubaNode& node) {
  Material m;
  m.kind = MaterialKind::coated_diffuse;
  if (node.type == "roughplastic") read_alpha(node, m);
  m.ior = float(index_of_refraction(node, "int_ior", "polypropylene") /
                index_of_refraction(node, "ext_ior", "air"));
  m.base_color = textures_.color(node, {"diffuse_reflectance"}, Rgb{0.5f});
  m.specular_color = textures_.color(node, {"specular_reflectance"}, Rgb{1});
  if (m.roughness.texture >= 0) m.facets = FacetModel::balanced;
  const bool is_rough = m.facets != FacetModel::balanced && m.roughness.value > 0;
  if (!get_flag(node, "nonlinear", false) && m.ior > 1) {
    const FacetShape shape =
        m.facets == FacetModel::single_beckmann ? FacetShape::beckmann : FacetShape::ggx;
    const float f =
        is_rough ? mean_rough_reflectance_inside(shape, double(m.roughness.value), double(m.ior))
                 : mean_reflectance_inside(double(m.ior));
    if (is_texture(m.base_color))
      m.base_color.texture = textures_.with_brightened_texels(m.base_color.texture, f);
    else
      for (size_t c = 0; c < 3; ++c)
        m.base_color.value[c] = from_white_base(m.base_color.value[c], f);
  }
  return m;
}

// Converts an exponent n to the GGX width α of an equally wide lobe: α² = 2 / (n + 2).
Material MitsubaBsdfs::phong(const MitsubaNode& node) {
  Material m;
  m.kind = MaterialKind::metallic_roughness;
  m.base_color = textures_.color(node, {"diffuse_reflectance"}, Rgb{0.5f});
  const ColorInput specular = textures_.color(node, {"specular_reflectance"}, Rgb{0.2f});
  m.roughness_meaning = RoughnessMeaning::alpha;
  if (node.type == "phong") {
    m.roughness = textures_.real(node, {"exponent"}, 30);
    m.roughness.value = std::sqrt(2 / (std::max(m.roughness.value, 0.0f) + 2));
    m.roughness.texture = no_texture;
  } else {
    read_alpha(node, m);
  }
  find_parameter(node, "variant");
  // Sets the index whose Fresnel reflectance at normal incidence is specular_reflectance, up to 3.
  const float f = std::sqrt(std::clamp(mean_of(specular), 0.0f, 0.25f));
  m.ior = (1 + f) / (1 - f);
  if (m.ior <= 1) m.specular.value = 0;
  approximate(node, "as a coat with its specular_reflectance at normal incidence");
  return m;
}

// Converts the opacity to the material's alpha.
std::optional<Material> MitsubaBsdfs::masked(const MitsubaNode& node) {
  const FloatInput opacity = textures_.real(node, {"opacity"}, 0.5f);
  std::optional<Material> m = nested(node);
  return m ? with_mask(node, std::move(*m), opacity) : m;
}

// Bump maps are heights in metres, multiplied by `scale`.
std::optional<Material> MitsubaBsdfs::bumped(const MitsubaNode& node) {
  std::optional<Material> m = nested(node);
  const auto scale = float(get_number(node, "scale", 1));
  get_flag(node, "use_shadowing_function", true);
  get_flag(node, "flip_invalid_normals", true);
  if (!m) return m;
  for (const MitsubaNode* child : node.children) {
    if (tree_.resolved(*child).tag != "texture") continue;
    child->is_used = true;
    if (node.type != "normalmap") {
      const FloatInput heights = textures_.real(*child);
      if (heights.texture >= 0) m->bump = {scale * heights.value, heights.texture, 0};
      continue;
    }
    const ColorInput normals = textures_.vector(*child);
    const bool is_upright = normals.value.r == 0.5f && normals.value.g == 0.5f;
    m->normal_texture = normals.texture;
    if (normals.texture < 0 && !is_upright) approximate(node, "without its constant normal");
  }
  return m;
}

// Returns the index of a copy whose inside absorbs that much per metre.
uint32_t MitsubaBsdfs::with_medium(uint32_t material, Rgb absorption) {
  const std::array<float, 4> key{float(material), absorption.r, absorption.g, absorption.b};
  const auto found = with_medium_.find(key);
  if (found != with_medium_.end()) return found->second;
  Material m = scene_.materials[material];
  m.absorption = absorption;
  scene_.materials.push_back(std::move(m));
  return with_medium_[key] = uint32_t(scene_.materials.size() - 1);
}

// Shows the same material on both sides. A second bsdf for the back is left out.
std::optional<Material> MitsubaBsdfs::two_sided(const MitsubaNode& node) {
  std::optional<Material> m = nested(node);
  if (m) m->back_faces = BackFaces::shown;
  size_t sides = 0;
  for (const MitsubaNode* child : node.children) {
    if (tree_.resolved(*child).tag != "bsdf") continue;
    child->is_used = true;
    if (++sides == 2) approximate(node, "its back as its front");
  }
  return m;
}

std::optional<Material> MitsubaBsdfs::convert_simple(const MitsubaNode& node) {
  const std::string& type = node.type;
  const auto is_any = [&](std::initializer_list<const char*> names) {
    return std::any_of(names.begin(), names.end(), [&](const char* n) { return type == n; });
  };
  if (is_any({"diffuse", "roughdiffuse"})) return one_sided(diffuse(node));
  if (is_any({"conductor", "roughconductor"})) return one_sided(conductor(node));
  if (is_any({"dielectric", "thindielectric", "roughdielectric"})) return dielectric(node);
  if (is_any({"plastic", "roughplastic"})) return one_sided(plastic(node));
  if (is_any({"principled", "principledthin"})) return principled(node);
  if (is_any({"phong", "ward"})) return one_sided(phong(node));
  if (is_any({"difftrans"})) {
    Material m;
    m.base_color.value = Rgb{0};
    m.diffuse_transmission.value = 1;
    m.diffuse_transmission_color = textures_.color(node, {"transmittance"}, Rgb{0.5f});
    return m;
  }
  if (is_any({"mask"})) return masked(node);
  if (is_any({"blendbsdf"})) return blended(node);
  if (is_any({"mixturebsdf", "mixture"})) return mixed(node);
  if (is_any({"coating", "roughcoating"})) return coated(node);
  if (is_any({"bumpmap", "bump", "normalmap"})) return bumped(node);
  if (is_any({"twosided"})) return two_sided(node);
  if (is_any({"null"})) return std::nullopt;
  if (is_any({"measured"})) {
    const std::string file = get_text(node, "filename", "");
    return one_sided(measured_material(tree_.folder(), file, scene_.warnings));
  }
  scene_.warnings.add("bsdf \"" + shortened(type) + "\" is not supported: shown diffuse grey");
  for (const MitsubaNode* child : node.children) child->is_used = true;
  Material m;
  const ColorInput c = textures_.color(
      node, {"reflectance", "transmittance", "diffuse_reflectance", "base_color"}, Rgb{0.5f});
  m.base_color = c;
  return m;
}

std::optional<Material> MitsubaBsdfs::convert(const MitsubaNode& node) {
  if (++depth_ > max_bsdf_depth) node.place.fail("bsdfs contain each other too deeply");
  node.is_used = true;
  std::optional<Material> m = convert_simple(node);
  warn_of_unused(node, scene_.warnings);
  --depth_;
  return m;
}

}  // namespace troffer
