#include "export/pbrt_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/coat.h"

namespace troffer {

namespace {

constexpr const char* coats_left_out =
    "clear coats over anything but metal, and thin ones, are not written";

std::string rgb(const char* name, Rgb c) {
  return fmt::format(" \"rgb {}\" [ {} {} {} ]", name, c.r, c.g, c.b);
}

float power_for_pbrt(RoughnessMeaning meaning) {
  return meaning == RoughnessMeaning::alpha_is_square ? 2
         : meaning == RoughnessMeaning::alpha_is_sqrt ? 0.5f
                                                      : 1;
}

// Returns the values of a look that determine its texels.
std::string key_of(const Texture& t) {
  return fmt::format(" {} {} {} {} {} {} {} {} {} {}", t.width, t.height, int(t.wrap_u),
                     int(t.wrap_v), t.uv_scale.x, t.uv_scale.y, t.uv_offset.x, t.uv_offset.y,
                     t.uv_rotation_rad, int(t.mapping));
}

// Converts the reflectance of a metal seen from within a coat of this index to its reflectance in
// air, which pbrt expects.
float reflectance_in_air(float r, float index) {
  const float c = std::clamp(r, 0.0f, 0.9999f), eta = 1 / index;
  const float k2 = std::max((c * sqr(eta + 1) - sqr(eta - 1)) / (1 - c), 0.0f) * sqr(index);
  return k2 / (4 + k2);
}

}  // namespace

const PbrtUvs& PbrtMaterialWriter::begin(uint32_t material, const Light* light) {
  const auto key = std::pair{material, light ? light->texture : no_texture};
  auto found = uvs_.find(key);
  if (found == uvs_.end())
    found = uvs_.emplace(key, PbrtUvs(scene_, mesh_uvs_, material, light, warnings_)).first;
  material_ = material;
  placing_ = &found->second;
  return *placing_;
}

// Returns the name of a texture with the image that `bake` makes: PNG, or floats if values exceed
// its range.
template <class Bake>
std::string PbrtMaterialWriter::texture(const std::string& key, const PbrtUvs::Placing& placing,
                                        bool is_number, const Bake& bake) {
  std::string& name = textures_[key + placing.parameters + key_of(placing.look)];
  if (!name.empty()) return name;
  name = fmt::format("texture{}", images_++);
  const BakedImage image = bake(placing.look);
  const bool has_floats = needs_floats(image);
  const std::string file = files_.write(name + (has_floats ? ".pfm" : ".png"),
                                        has_floats ? pfm_of(image) : png_of(image));
  definitions_ += fmt::format(
      "Texture \"{}\" \"{}\" \"imagemap\" \"string filename\" \"{}\" \"string encoding\" "
      "\"{}\"{}{}\n",
      name, is_number ? "float" : "spectrum", file,
      image.is_srgb && !has_floats ? "sRGB" : "linear", placing.parameters,
      image.scale != 1 && !has_floats ? fmt::format(" \"float scale\" {}", image.scale) : "");
  return name;
}

std::string PbrtMaterialWriter::color(const char* parameter, const ColorInput& input,
                                      const ColorChange& change) {
  const auto placing = placing_->placing(std::array{input.texture});
  if (!placing) return rgb(parameter, clamp01(color_at(scene_, input, {0, 0}, change)));
  const Rgb v = input.value;
  const std::string key = fmt::format("color {} {} {} {} {}", input.texture, v.r, v.g, v.b,
                                      change ? change(0.5f) : 0.0f);
  return fmt::format(" \"texture {}\" \"{}\"", parameter,
                     texture(key, *placing, false, [&](const Texture& look) {
                       return baked_color(scene_, input, look, nullptr, change);
                     }));
}

// Writes the GGX width itself.
std::string PbrtMaterialWriter::roughness(const Material& m, float power) {
  return width("roughness", m.roughness, power) + " \"bool remaproughness\" false";
}

std::string PbrtMaterialWriter::width(const char* parameter, const FloatInput& input, float power) {
  const auto placing = placing_->placing(std::array{input.texture});
  if (!placing) {
    const float r = std::pow(std::max(evaluate(scene_.textures, input, Vec2{0, 0}), 0.0f), power);
    return fmt::format(" \"float {}\" {}", parameter, r);
  }
  const std::string key =
      fmt::format("number {} {} {} {}", input.texture, input.channel, input.value, power);
  return fmt::format(" \"texture {}\" \"{}\"", parameter,
                     texture(key, *placing, true, [&](const Texture& look) {
                       return baked_number(scene_, input, look, power);
                     }));
}

// Returns the parameters of a conductor; prefix: of the names of index and extinction.
std::string PbrtMaterialWriter::metal_text(const Material& m, const std::string& prefix) {
  if (m.is_reflectance) return color("reflectance", m.base_color);
  if (m.specular_color.texture < 0 && m.specular_color.value == Rgb{1})
    return rgb((prefix + "eta").c_str(), m.eta) + rgb((prefix + "k").c_str(), m.k);
  warnings_.add(
      "metals with an index of refraction and a factor are written by their reflectance at normal "
      "incidence");
  const Rgb below = m.eta - Rgb{1}, above = m.eta + Rgb{1}, k2 = m.k * m.k;
  ColorInput factor = m.specular_color;
  factor.value *= (below * below + k2) / (above * above + k2);
  return color("reflectance", factor);
}

// Returns a conductor, or glTF's metal under a coat that does not refract. pbrt's coat refracts and
// widens the gloss by its index, so the width is divided by that.
std::string PbrtMaterialWriter::coated_metal_text(const Material& m) {
  const float power = power_for_pbrt(m.roughness_meaning);
  const bool bends = m.kind == MaterialKind::conductor;
  FloatInput base = m.roughness;
  ColorChange change;
  if (!bends) {
    warnings_.add("clear coats over glTF's metal are written as pbrt's, which refract light");
    base.value *= std::pow(m.coat_ior, -1 / power);
    change = [&m](float v) { return reflectance_in_air(v, m.coat_ior); };
  }
  const std::string metal =
      bends ? metal_text(m, "conductor.") : color("reflectance", m.base_color, change);
  return fmt::format("\"coatedconductor\" \"float interface.eta\" {}", m.coat_ior) + metal +
         width("conductor.roughness", base, power) +
         width("interface.roughness", m.coat_roughness, power) + " \"bool remaproughness\" false";
}

// Returns diffuse reflection (`base`) and transmission.
std::string PbrtMaterialWriter::translucent_text(const Material& m, const ColorInput& base) {
  ColorInput through = m.diffuse_transmission_color;
  through.value *= m.diffuse_transmission.value;
  if (m.diffuse_transmission.texture >= 0)
    warnings_.add("transmission textures are written as one value");
  return "\"diffusetransmission\"" + color("reflectance", base) + color("transmittance", through);
}

// Returns the dominant part of glTF's mixture.
std::string PbrtMaterialWriter::mixed_text(const Material& m) {
  const float metallic = evaluate(scene_.textures, m.metallic, Vec2{0.5f, 0.5f});
  const float transmission = evaluate(scene_.textures, m.transmission, Vec2{0.5f, 0.5f});
  const float power = power_for_pbrt(m.roughness_meaning);
  const bool is_mixed = (metallic > 0 && metallic < 1) || (transmission > 0 && transmission < 1);
  warnings_.add(
      is_mixed
          ? "mixtures of metal, coat and glass are written as the part with the largest weight: "
            "pbrt has no such mixtures"
          : "metal, coat and glass of glTF's model are written as pbrt's, which differ slightly");
  if (metallic >= 0.5f && m.coat.value >= 0.5f) return coated_metal_text(m);
  if (m.coat.value > 0) warnings_.add(coats_left_out);
  if (metallic >= 0.5f)
    return "\"conductor\"" + color("reflectance", m.base_color) + roughness(m, power);
  if (transmission >= 0.5f)
    return m.is_thin ? fmt::format("\"thindielectric\" \"float eta\" {}", m.ior)
                     : fmt::format("\"dielectric\" \"float eta\" {}", m.ior) + roughness(m, power);
  if (m.diffuse_transmission.value > 0) {
    if (m.specular.value > 0)
      warnings_.add("gloss on diffusely transmitting surfaces is not written: pbrt has none");
    ColorInput base = m.base_color;
    base.value *= 1 - m.diffuse_transmission.value;
    return translucent_text(m, base);
  }
  if (m.specular.value <= 0) return "\"diffuse\"" + color("reflectance", m.base_color);
  // An index of 0 stands for gloss that is equal at all angles.
  const float even = std::sqrt(std::clamp(m.specular.value, 0.0f, 0.9f));
  const float ior = m.ior > 0 ? m.ior : (1 + even) / (1 - even);
  // glTF's base reflects as if all light that returns to it met a white base.
  const float f = mean_reflectance_inside(double(ior));
  return fmt::format("\"coateddiffuse\" \"float eta\" {}", ior) +
         color("reflectance", m.base_color, [f](float v) { return from_white_base(v, f); }) +
         roughness(m, power);
}

std::string PbrtMaterialWriter::material_text(const Material& m) {
  const bool has_factor = m.specular_color.texture >= 0 || m.specular_color.value != Rgb{1};
  if (has_factor && (m.kind == MaterialKind::coated_diffuse || m.kind == MaterialKind::dielectric))
    warnings_.add("factors on the reflection of coats and glass are not written");
  const float power = power_for_pbrt(m.roughness_meaning);
  switch (m.kind) {
    case MaterialKind::diffuse:
      return m.diffuse_transmission.value > 0 ? translucent_text(m, m.base_color)
                                              : "\"diffuse\"" + color("reflectance", m.base_color);
    case MaterialKind::coated_diffuse:
      return fmt::format("\"coateddiffuse\" \"float eta\" {}", m.ior) +
             color("reflectance", m.base_color) + roughness(m, power);
    case MaterialKind::conductor:
      if (m.coat.value > 0) return coated_metal_text(m);
      return "\"conductor\"" + metal_text(m, "") + roughness(m, power);
    case MaterialKind::dielectric:
      if (m.coat.value > 0) warnings_.add(coats_left_out);
      if (m.base_color.texture >= 0 || m.base_color.value != Rgb{1})
        warnings_.add("pbrt's glass has no tint: it is written clear");
      if (m.is_thin) return fmt::format("\"thindielectric\" \"float eta\" {}", m.ior);
      return fmt::format("\"dielectric\" \"float eta\" {}", m.ior) + roughness(m, power);
    case MaterialKind::metallic_roughness:
      return mixed_text(m);
    case MaterialKind::angular:
      warnings_.add("matrices of directional scattering (BSDF) are written as clear glass");
      return "\"thindielectric\" \"float eta\" 1.5";
  }
  return "\"diffuse\"";
}

// Returns the medium inside absorbing glass. Shapes lie between AttributeBegin and AttributeEnd.
std::string PbrtMaterialWriter::medium_text(const Material& m) {
  if (m.absorption.is_black()) return "";
  if (m.is_thin) {
    warnings_.add("absorption in sheets of glass is not written: pbrt has none");
    return "";
  }
  const std::string name = fmt::format("medium{}", media_++);
  return fmt::format("MakeNamedMedium \"{}\" \"string type\" \"homogeneous\"", name) +
         rgb("sigma_a", m.absorption) + rgb("sigma_s", Rgb{0}) +
         fmt::format("\nMediumInterface \"{}\" \"\"\n", name);
}

// pbrt's normal map uses the mesh's coordinates; its y is normal × x (pbrt_uvs.h).
std::string PbrtMaterialWriter::normal_map(const Material& m, bool is_turned) {
  if (!placing_->has_normals()) return "";
  const bool is_v_up = scene_.textures[size_t(m.normal_texture)].uv_scale.y < 0;
  const Vec2 signs = placing_->normal_signs(is_turned, is_v_up);
  const Vec2 factors{signs.x * m.normal_scale, signs.y * m.normal_scale};
  const Texture& look = placing_->normal();
  const std::string key =
      fmt::format("normals {} {} {} ", m.normal_texture, factors.x, factors.y) + key_of(look);
  std::string& file = textures_[key];
  if (file.empty())
    file = files_.write(fmt::format("normals{}.png", images_++),
                        png_of(baked_normals(scene_, uint32_t(m.normal_texture), look, factors)));
  return fmt::format(" \"string normalmap\" \"{}\"", file);
}

// Writes an image of heights. pbrt, too, treats displacement as bumps.
std::string PbrtMaterialWriter::displacement(const Material& m) {
  const auto placing = placing_->placing(std::array{m.bump.texture});
  if (!placing) return "";
  const std::string key =
      fmt::format("heights {} {} {}", m.bump.texture, m.bump.channel, m.bump.value);
  return fmt::format(" \"texture displacement\" \"{}\"",
                     texture(key, *placing, true, [&](const Texture& look) {
                       return baked_heights(scene_, m.bump, look);
                     }));
}

std::string PbrtMaterialWriter::use(bool is_turned) {
  const Material& m = scene_.materials[material_];
  std::string text = "Material " + material_text(m) + normal_map(m, is_turned) + displacement(m);
  tell_what_is_left_out(scene_, m, false, warnings_);
  text = medium_text(m) + text;
  alpha();  // defines its texture first
  std::string out = std::move(definitions_);
  definitions_.clear();
  return out + text;
}

bool PbrtMaterialWriter::is_nothing() const {
  const Material& m = scene_.materials[material_];
  return m.is_alpha_masked && !has_image(scene_, m.alpha.texture) &&
         coverage(scene_.textures, m, Vec2{0, 0}) <= 0;
}

// pbrt's alpha is the share of rays that hit. A mask is written after its cutoff, at a higher
// resolution than its image, to keep the edges of holes.
std::string PbrtMaterialWriter::alpha() {
  constexpr int finer = 4, most_texels_across = 4096;
  const Material& m = scene_.materials[material_];
  if (!m.is_alpha_masked) return "";
  auto placing = placing_->placing(std::array{m.alpha.texture});
  if (!placing) {
    const float share = coverage(scene_.textures, m, Vec2{0, 0});
    return share < 1 ? fmt::format(" \"float alpha\" {}", share) : "";
  }
  const FloatInput& a = m.alpha;
  if (m.is_alpha_blended) {
    const std::string key = fmt::format("alpha {} {} {}", a.texture, a.channel, a.value);
    return fmt::format(
        " \"texture alpha\" \"{}\"", texture(key, *placing, true, [&](const Texture& look) {
          return a.value <= 1 ? baked_heights(scene_, a, look) : baked_number(scene_, a, look, 1);
        }));
  }
  const std::string key =
      fmt::format("holes {} {} {} {}", a.texture, a.channel, a.value, m.alpha_cutoff);
  std::string parameters = placing->parameters;
  if (const size_t at = parameters.find("\"bilinear\""); at != std::string::npos)
    parameters.replace(at, 10, "\"point\"");
  Texture look = placing->look;
  const int times = std::clamp(
      look.is_filtered ? most_texels_across / std::max(look.width, look.height) : 1, 1, finer);
  look.width *= times;
  look.height *= times;
  return fmt::format(" \"texture alpha\" \"{}\"",
                     texture(key, {look, parameters}, true,
                             [&](const Texture& fine) { return baked_holes(scene_, m, fine); }));
}

std::pair<std::string, float> PbrtMaterialWriter::emission_image(const ColorInput& emission) {
  const Texture& look = placing_->emission();
  const Rgb v = emission.value / std::max(max_component(emission.value), 1e-30f);
  const std::string key =
      fmt::format("emission {} {} {} {} ", emission.texture, v.r, v.g, v.b) + key_of(look);
  const BakedImage image = baked_color(scene_, {v, emission.texture}, look, nullptr);
  std::string& file = textures_[key];
  const bool has_floats = needs_floats(image);
  if (file.empty())
    file = files_.write(fmt::format("emission{}.{}", images_++, has_floats ? "pfm" : "png"),
                        has_floats ? pfm_of(image) : png_of(image));
  return {file, (has_floats ? 1 : image.scale) * max_component(emission.value)};
}

}  // namespace troffer
