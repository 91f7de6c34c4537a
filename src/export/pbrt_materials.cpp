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

const char* wrap_name(WrapMode mode) {
  return mode == WrapMode::clamp ? "clamp" : mode == WrapMode::black ? "black" : "repeat";
}

// Where (u,v) with v down is looked up, said with v up.
std::string mapping(const Texture& t) {
  const auto plus_zero = [](float v) { return v + 0.0f; };
  return fmt::format(
      " \"float uscale\" {} \"float vscale\" {} \"float udelta\" {} \"float vdelta\" {} \"string "
      "wrap\" \"{}\" \"string filter\" \"{}\"",
      t.uv_scale.x, plus_zero(-t.uv_scale.y), t.uv_offset.x, plus_zero(1 - t.uv_offset.y),
      wrap_name(t.wrap_u), t.is_filtered ? "bilinear" : "point");
}

float power_for_pbrt(RoughnessMeaning meaning) {
  return meaning == RoughnessMeaning::alpha_is_square ? 2
         : meaning == RoughnessMeaning::alpha_is_sqrt ? 0.5f
                                                      : 1;
}

// Of a metal of that reflectance seen from within a coat of that index: what pbrt, which tells a
// metal as seen from air, calls its reflectance.
float reflectance_in_air(float r, float index) {
  const float c = std::clamp(r, 0.0f, 0.9999f), eta = 1 / index;
  const float k2 = std::max((c * sqr(eta + 1) - sqr(eta - 1)) / (1 - c), 0.0f) * sqr(index);
  return k2 / (4 + k2);
}

}  // namespace

std::string PbrtMaterialWriter::texture_name(const std::string& key, const BakedImage& image,
                                             const Texture* look, bool is_number) {
  std::string& name = textures_[key];
  if (name.empty()) name = image_texture(image, look, is_number);
  return name;
}

std::string PbrtMaterialWriter::image_texture(const BakedImage& image, const Texture* look,
                                              bool is_number) {
  const std::string name = fmt::format("texture{}", images_++);
  files_.write(name + ".png", png_of(image));
  if (look && look->uv_rotation_rad != 0)
    warnings_.add("pbrt cannot turn textures: their rotation is left out");
  if (look && look->wrap_u != look->wrap_v)
    warnings_.add("pbrt repeats or clamps textures along both axes alike: as along u");
  if (look && look->wrap_u == WrapMode::mirror)
    warnings_.add("pbrt cannot mirror textures: they are repeated");
  definitions_ += fmt::format(
      "Texture \"{}\" \"{}\" \"imagemap\" \"string filename\" \"{}\" \"string encoding\" "
      "\"{}\"{}{}\n",
      name, is_number ? "float" : "spectrum", files_.relative(name + ".png"),
      image.is_srgb ? "sRGB" : "linear", look ? mapping(*look) : "",
      image.scale != 1 ? fmt::format(" \"float scale\" {}", image.scale) : "");
  return name;
}

std::string PbrtMaterialWriter::color(const char* parameter, const ColorInput& input,
                                      const ColorChange& change) {
  const Texture* look = image_of(scene_, input.texture);
  if (!look) {
    return rgb(parameter, clamp01(color_at(scene_, input, {0, 0}, change)));
  }
  const Rgb v = input.value;
  const std::string key = fmt::format("color {} {} {} {} {}", input.texture, v.r, v.g, v.b,
                                      change ? change(0.5f) : 0.0f);
  const std::string name =
      textures_.contains(key)
          ? textures_[key]
          : texture_name(key, baked_color(scene_, input, false, change), look, false);
  return fmt::format(" \"texture {}\" \"{}\"", parameter, name);
}

// As the width of ggx itself.
std::string PbrtMaterialWriter::roughness(const Material& m, float power) {
  return width("roughness", m.roughness, power) + " \"bool remaproughness\" false";
}

std::string PbrtMaterialWriter::width(const char* parameter, const FloatInput& input, float power) {
  const Texture* look = image_of(scene_, input.texture);
  if (!look) {
    const float r = std::pow(std::max(evaluate(scene_.textures, input, Vec2{0, 0}), 0.0f), power);
    return fmt::format(" \"float {}\" {}", parameter, r);
  }
  const std::string key =
      fmt::format("number {} {} {} {}", input.texture, input.channel, input.value, power);
  const std::string name = textures_.contains(key)
                               ? textures_[key]
                               : texture_name(key, baked_number(scene_, input, power), look, true);
  return fmt::format(" \"texture {}\" \"{}\"", parameter, name);
}

// Of a conductor; prefix: of the names of index and extinction.
std::string PbrtMaterialWriter::metal_text(const Material& m, const std::string& prefix) {
  if (m.is_reflectance) return color("reflectance", m.base_color);
  if (m.specular_color.texture < 0 && m.specular_color.value == Rgb{1})
    return rgb((prefix + "eta").c_str(), m.eta) + rgb((prefix + "k").c_str(), m.k);
  warnings_.add("metals of an index and a factor are written by their reflectance straight on");
  const Rgb below = m.eta - Rgb{1}, above = m.eta + Rgb{1}, k2 = m.k * m.k;
  ColorInput factor = m.specular_color;
  factor.value *= (below * below + k2) / (above * above + k2);
  return color("reflectance", factor);
}

// A conductor, or glTF's metal, into whose coat light does not bend: its gloss spreads by the index
// where it leaves pbrt's.
std::string PbrtMaterialWriter::coated_metal_text(const Material& m) {
  const float power = power_for_pbrt(m.roughness_meaning);
  const bool bends = m.kind == MaterialKind::conductor;
  FloatInput base = m.roughness;
  ColorChange change;
  if (!bends) {
    warnings_.add("clear coats over glTF's metal are written as pbrt's, into which light bends");
    base.value *= std::pow(m.coat_ior, -1 / power);
    change = [&m](float v) { return reflectance_in_air(v, m.coat_ior); };
  }
  const std::string metal =
      bends ? metal_text(m, "conductor.") : color("reflectance", m.base_color, change);
  return fmt::format("\"coatedconductor\" \"float interface.eta\" {}", m.coat_ior) + metal +
         width("conductor.roughness", base, power) +
         width("interface.roughness", m.coat_roughness, power) + " \"bool remaproughness\" false";
}

// What comes back and what comes through; base: the former.
std::string PbrtMaterialWriter::translucent_text(const Material& m, const ColorInput& base) {
  ColorInput through = m.diffuse_transmission_color;
  through.value *= m.diffuse_transmission.value;
  if (m.diffuse_transmission.texture >= 0)
    warnings_.add("textures of how much light comes through are written as one value");
  return "\"diffusetransmission\"" + color("reflectance", base) + color("transmittance", through);
}

// glTF's mixture by the part of it that has most weight.
std::string PbrtMaterialWriter::mixed_text(const Material& m) {
  const float metallic = evaluate(scene_.textures, m.metallic, Vec2{0.5f, 0.5f});
  const float transmission = evaluate(scene_.textures, m.transmission, Vec2{0.5f, 0.5f});
  const float power = power_for_pbrt(m.roughness_meaning);
  const bool is_mixed = (metallic > 0 && metallic < 1) || (transmission > 0 && transmission < 1);
  warnings_.add(is_mixed ? "mixtures of metal, coat and glass are written as the one that has most "
                           "weight: pbrt has none"
                         : "metal, coat and glass of glTF's model are written as pbrt's, which "
                           "differ a little");
  if (metallic >= 0.5f && m.coat.value >= 0.5f) return coated_metal_text(m);
  if (m.coat.value > 0) warnings_.add(coats_left_out);
  if (metallic >= 0.5f)
    return "\"conductor\"" + color("reflectance", m.base_color) + roughness(m, power);
  if (transmission >= 0.5f)
    return m.is_thin ? fmt::format("\"thindielectric\" \"float eta\" {}", m.ior)
                     : fmt::format("\"dielectric\" \"float eta\" {}", m.ior) + roughness(m, power);
  if (m.diffuse_transmission.value > 0) {
    if (m.specular.value > 0)
      warnings_.add("the gloss of what light passes evenly is not written: pbrt has none");
    ColorInput base = m.base_color;
    base.value *= 1 - m.diffuse_transmission.value;
    return translucent_text(m, base);
  }
  if (m.specular.value <= 0) return "\"diffuse\"" + color("reflectance", m.base_color);
  // An index of 0 stands for gloss that is the same at all angles.
  const float even = std::sqrt(std::clamp(m.specular.value, 0.0f, 0.9f));
  const float ior = m.ior > 0 ? m.ior : (1 + even) / (1 - even);
  // glTF's base reflects as if all that comes back to it met a white one.
  const float f = mean_reflectance_inside(double(ior));
  return fmt::format("\"coateddiffuse\" \"float eta\" {}", ior) +
         color("reflectance", m.base_color, [f](float v) { return from_white_base(v, f); }) +
         roughness(m, power);
}

std::string PbrtMaterialWriter::material_text(const Material& m) {
  const bool has_factor = m.specular_color.texture >= 0 || m.specular_color.value != Rgb{1};
  if (has_factor && (m.kind == MaterialKind::coated_diffuse || m.kind == MaterialKind::dielectric))
    warnings_.add("factors on what coats and glass reflect are not written");
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
  }
  return "\"diffuse\"";
}

// What glass absorbs inside. Shapes are within AttributeBegin and AttributeEnd.
std::string PbrtMaterialWriter::medium_text(const Material& m) {
  if (m.absorption.is_black()) return "";
  if (m.is_thin) {
    warnings_.add("what sheets of glass absorb is not written: pbrt has none");
    return "";
  }
  const std::string name = fmt::format("medium{}", media_++);
  return fmt::format("MakeNamedMedium \"{}\" \"string type\" \"homogeneous\"", name) +
         rgb("sigma_a", m.absorption) + rgb("sigma_s", Rgb{0}) +
         fmt::format("\nMediumInterface \"{}\" \"\"\n", name);
}

std::string PbrtMaterialWriter::use(uint32_t material) {
  const Material& m = scene_.materials[material];
  std::string text = "Material " + material_text(m);
  if (m.normal_texture >= 0) {
    const std::string name = fmt::format("normals{}", m.normal_texture);
    std::string& file = textures_[name];
    if (file.empty()) {
      file = files_.relative(name + ".png");
      files_.write(name + ".png", png_of(baked_raw(scene_, uint32_t(m.normal_texture))));
    }
    text += fmt::format(" \"string normalmap\" \"{}\"", file);
  }
  tell_what_is_left_out(scene_, m, false, warnings_);
  text = medium_text(m) + text;
  alpha_of(material);  // its texture is defined before
  std::string out = std::move(definitions_);
  definitions_.clear();
  return out + text;
}

std::string PbrtMaterialWriter::alpha_of(uint32_t material) {
  const Material& m = scene_.materials[material];
  if (!m.is_alpha_masked) return "";
  // pbrt's holes are where it is below 0.5 here.
  FloatInput alpha = m.alpha;
  if (m.alpha_cutoff > 0) alpha.value *= 0.5f / m.alpha_cutoff;
  const Texture* look = image_of(scene_, alpha.texture);
  if (!look) return fmt::format(" \"float alpha\" {}", alpha.value >= 0.5f ? 1 : 0);
  const std::string key =
      fmt::format("number {} {} {} 1", alpha.texture, alpha.channel, alpha.value);
  const std::string name = textures_.contains(key)
                               ? textures_[key]
                               : texture_name(key, baked_number(scene_, alpha, 1), look, true);
  return fmt::format(" \"texture alpha\" \"{}\"", name);
}

std::pair<std::string, float> PbrtMaterialWriter::emission_image(const ColorInput& emission) {
  const BakedImage image = baked_color(scene_, emission, false);
  const std::string name = fmt::format("emission{}.png", images_++);
  files_.write(name, png_of(image));
  return {files_.relative(name), image.scale};
}

}  // namespace troffer
