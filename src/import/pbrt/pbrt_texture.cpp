#include "import/pbrt/pbrt_texture.h"

#include <cmath>
#include <cstdlib>

#include "import/file.h"

namespace troffer {

namespace {

constexpr size_t max_images_per_lookup = 64;
constexpr int max_pbrt_texture_depth = 100;

// Converts from pbrt's v, which points up, to the scene's, which points down.
void turn_upside_down(Texture& look, Vec2 scale, Vec2 offset) {
  look.uv_scale = {scale.x, -scale.y};
  look.uv_offset = {offset.x, 1 - offset.y};
}

WrapMode wrap_mode(const PbrtParams& params, WarningLog& warnings) {
  const std::string wrap = params.get_string("wrap", "repeat");
  if (wrap == "repeat") return WrapMode::repeat;
  if (wrap == "clamp") return WrapMode::clamp;
  if (wrap == "black") return WrapMode::black;
  warnings.add(params.owner + ": wrap mode \"" + wrap + "\" is not supported; repeated instead");
  return WrapMode::repeat;
}

// Linear value of channel `i` of the texels.
float linear_texel(const Texture& t, size_t i) {
  if (t.texels8.empty()) return t.texels_float[i];
  const float v = float(t.texels8[i]) / 255.0f;
  return t.is_srgb ? linear_from_srgb(v) : v;
}

// One-channel copy: the mean of the colour channels, as pbrt reads images for floats [1].
Texture grey_copy(const Texture& t) {
  Texture grey = t;
  grey.channels = 1;
  grey.texels8.clear();
  const size_t texels = size_t(t.width) * size_t(t.height), stride = size_t(t.channels);
  const size_t colors = stride >= 3 ? 3 : 1;
  grey.texels_float.assign(texels, 0);
  for (size_t i = 0; i < texels; ++i) {
    float sum = 0;
    for (size_t c = 0; c < colors; ++c) sum += linear_texel(t, i * stride + c);
    grey.texels_float[i] = sum / float(colors);
  }
  return grey;
}

// Copy decoded by a power law. Alpha is unchanged.
Texture gamma_copy(const Texture& t, float gamma) {
  Texture decoded = t;
  decoded.texels_float.resize(t.texels8.size());
  const size_t stride = size_t(t.channels);
  const size_t alpha = stride == 2 ? 1 : stride == 4 ? 3 : stride;
  for (size_t i = 0; i < t.texels8.size(); ++i) {
    const float v = float(t.texels8[i]) / 255.0f;
    decoded.texels_float[i] = i % stride == alpha ? v : std::pow(v, gamma);
  }
  decoded.texels8.clear();
  return decoded;
}

}  // namespace

void PbrtTextures::define(const std::string& name, bool is_float, const std::string& kind,
                          PbrtParams params, const Affine& world_from_texture) {
  auto& named = is_float ? floats_ : colors_;
  if (named.contains(name))
    scene_.warnings.add(at_place(params.place, "texture \"" + name + "\" is defined again"));
  Named texture;
  texture.kind = kind;
  texture.is_float = is_float;
  texture.params = std::move(params);
  texture.world_from_texture = world_from_texture;
  named[name] = std::move(texture);
}

PbrtTextures::Named& PbrtTextures::find(const std::string& name, bool is_float,
                                        const PbrtParam& asked_by) {
  auto& named = is_float ? floats_ : colors_;
  auto found = named.find(name);
  // A float texture may stand in for a grey spectrum.
  if (found == named.end() && !is_float) {
    found = floats_.find(name);
    if (found == floats_.end()) found = named.end();
  }
  if (found == named.end())
    fail_at(asked_by.place, "no " + std::string(is_float ? "float" : "spectrum") + " texture \"" +
                                name + "\" is defined before this point");
  if (found->second.is_being_made)
    fail_at(asked_by.place, "texture \"" + name + "\" contains itself");
  if (!found->second.is_made) make(found->second, name);
  return found->second;
}

void PbrtTextures::make(Named& texture, const std::string& name) {
  if (++depth_ > max_pbrt_texture_depth)
    fail_at(texture.params.place, "textures are nested too deeply");
  texture.is_being_made = true;
  if (texture.kind == "constant") {
    texture.value = argument(texture.params, "value", texture.is_float, Rgb{1}, texture.images);
  } else if (texture.kind == "imagemap") {
    make_image(texture, name);
  } else if (texture.kind == "scale") {
    make_scale(texture, name);
  } else if (!(texture.kind == "checkerboard" && make_checkerboard(texture, name)) &&
             !(texture.kind == "mix" && make_mix(texture)) && !make_pattern(texture, name)) {
    make_mean(texture);
  }
  texture.params.warn_unread(scene_.warnings);
  texture.is_being_made = false;
  texture.is_made = true;
  --depth_;
}

ColorInput PbrtTextures::argument(const PbrtParams& params, std::string_view name, bool is_float,
                                  Rgb fallback, size_t& images) {
  const PbrtParam* param = params.find(name);
  if (!param) return {fallback, no_texture};
  if (param->type != PbrtType::texture)
    return {
        is_float ? Rgb{float(params.get_float(name, 0))} : factor_value(*param, spectrum_context()),
        no_texture};
  if (param->strings.size() != 1)
    fail_at(param->place, "parameter \"" + param->name + "\" needs the name of one texture");
  const Named& texture = find(param->strings[0], is_float, *param);
  images += texture.images;
  if (images > max_images_per_lookup)
    fail_at(param->place,
            "a product of more than " + std::to_string(max_images_per_lookup) + " images");
  return texture.value;
}

// Finds strings in quotes after "string filename". A false match does no harm. Names with escape
// sequences are not found.
void PbrtTextures::expect_images_of(std::string_view text) {
  constexpr std::string_view parameter = "filename\"";
  constexpr size_t most_between = 64, most_name = 4096, most_images = 4096;
  if (!loader_.decodes_ahead()) return;
  for (size_t at = text.find(parameter);
       at != std::string_view::npos && expected_.size() < most_images;
       at = text.find(parameter, at)) {
    at += parameter.size();
    const size_t begin = text.find('"', at) + 1;
    if (begin == 0 || begin > at + most_between) continue;
    const size_t end = text.find('"', begin);
    if (end == std::string_view::npos || end > begin + most_name) continue;
    const std::string name(text.substr(begin, end - begin));
    const std::string ending = lower_case_ending(name);
    if (ending != "png" && ending != "jpg" && ending != "jpeg" && ending != "tga" &&
        ending != "webp")
      continue;
    if (!expected_.insert(name).second) continue;
    const ConfinedPath path = confined_path(folder_, name);
    if (path.is_fine()) loader_.expect_file(path.path);
  }
}

int32_t PbrtTextures::load(const std::string& file, const Texture& look) {
  const ConfinedPath path = confined_path(folder_, file);
  return path.is_fine() ? loader_.from_file(path.path, look)
                        : loader_.missing(file, path.problem, look);
}

int32_t PbrtTextures::image(const std::string& file, bool is_srgb, WrapMode wrap) {
  Texture look;
  look.is_srgb = is_srgb;
  look.wrap_u = look.wrap_v = wrap;
  turn_upside_down(look, {1, 1}, {0, 0});
  return load(file, look);
}

void PbrtTextures::make_image(Named& texture, const std::string& name) {
  const PbrtParams& params = texture.params;
  WarningLog& warnings = scene_.warnings;
  Texture look;
  look.name = name;
  look.value = Rgb{float(params.get_float("scale", 1))};
  look.is_inverted = params.get_bool("invert", false);
  if (look.is_inverted && look.value != Rgb{1})
    warnings.add(params.owner + ": invert with a scale is read as scale × (1 - image)");
  look.is_filtered = params.get_string("filter", "bilinear") != "point";
  look.wrap_u = look.wrap_v = wrap_mode(params, warnings);
  const bool is_mapped = params.get_string("mapping", "uv") != "uv";
  const Vec2 scale(float(params.get_float("uscale", 1)), float(params.get_float("vscale", 1)));
  const Vec2 offset(float(params.get_float("udelta", 0)), float(params.get_float("vdelta", 0)));
  turn_upside_down(look, scale, offset);
  const std::string encoding = params.get_string("encoding", "sRGB");
  double gamma = 1;
  if (encoding.starts_with("gamma "))
    gamma = std::strtod(encoding.c_str() + 6, nullptr);
  else if (encoding != "sRGB" && encoding != "linear")
    warnings.add(params.owner + ": encoding \"" + encoding + "\" is unknown; read as sRGB");
  look.is_srgb = encoding != "linear" && !encoding.starts_with("gamma ");
  params.ignore({"maxanisotropy"});

  const PbrtParam* file = params.find("filename");
  if (!file) fail_at(params.place, params.owner + " needs a \"string filename\"");
  int32_t index = load(params.get_string("filename", ""), look);
  const auto append = [&](Texture changed) {
    index = int32_t(scene_.textures.size());
    scene_.textures.push_back(std::move(changed));
  };
  const auto is_image = [&] { return scene_.textures[size_t(index)].kind == TextureKind::image; };
  if (is_image() && gamma != 1 && gamma > 0 && !scene_.textures[size_t(index)].texels8.empty())
    append(gamma_copy(scene_.textures[size_t(index)], float(gamma)));
  if (is_image() && texture.is_float && scene_.textures[size_t(index)].channels > 1)
    append(grey_copy(scene_.textures[size_t(index)]));
  if (is_image() && is_mapped) {  // maps a position in space instead of (u,v)
    append(scene_.textures[size_t(index)]);
    Texture& mapped = scene_.textures.back();
    turn_upside_down(mapped, {1, 1}, {0, 0});
    read_mapping(texture, false, mapped);
  }
  texture.value = {Rgb{1}, index};
  texture.images = 1;
}

void PbrtTextures::make_scale(Named& texture, const std::string& name) {
  const PbrtParams& params = texture.params;
  const ColorInput a = argument(params, "tex", texture.is_float, Rgb{1}, texture.images);
  // The scale is a float texture or value; an rgb value is accepted too.
  const PbrtParam* scale = params.find("scale");
  const bool is_float = !scale || scale->type != PbrtType::rgb;
  const ColorInput b = argument(params, "scale", is_float, Rgb{1}, texture.images);
  texture.value.value = a.value * b.value;
  if (a.texture < 0 || b.texture < 0) {
    texture.value.texture = std::max(a.texture, b.texture);
    return;
  }
  Texture product;
  product.name = name;
  product.kind = TextureKind::product;
  product.factor_a = uint32_t(a.texture);
  product.factor_b = uint32_t(b.texture);
  texture.value.texture = int32_t(scene_.textures.size());
  scene_.textures.push_back(std::move(product));
}

// Makes a checkerboard of two plain colours as an image of four texels.
bool PbrtTextures::make_checkerboard(Named& texture, const std::string& name) {
  const PbrtParams& params = texture.params;
  size_t images = 0;
  const ColorInput a = argument(params, "tex1", texture.is_float, Rgb{1}, images);
  const ColorInput b = argument(params, "tex2", texture.is_float, Rgb{0}, images);
  if (a.texture >= 0 || b.texture >= 0 || params.get_int("dimension", 2) != 2 ||
      params.get_string("mapping", "uv") != "uv")
    return false;
  Texture image;
  image.name = name;
  image.kind = TextureKind::image;
  image.width = image.height = 2;
  image.channels = 3;
  image.is_filtered = image.is_srgb = false;
  // the top row first, since v points down
  for (const Rgb& c : {b.value, a.value, a.value, b.value})
    image.texels_float.insert(image.texels_float.end(), {c.r, c.g, c.b});
  turn_upside_down(
      image,
      Vec2(float(params.get_float("uscale", 1) / 2), float(params.get_float("vscale", 1) / 2)),
      Vec2(float(params.get_float("udelta", 0) / 2), float(params.get_float("vdelta", 0) / 2)));
  texture.value = {Rgb{1}, int32_t(scene_.textures.size())};
  texture.images = 1;
  scene_.textures.push_back(std::move(image));
  return true;
}

// Mixes two plain values.
bool PbrtTextures::make_mix(Named& texture) {
  const PbrtParams& params = texture.params;
  size_t images = 0;
  const ColorInput a = argument(params, "tex1", texture.is_float, Rgb{0}, images);
  const ColorInput b = argument(params, "tex2", texture.is_float, Rgb{1}, images);
  const ColorInput amount = argument(params, "amount", true, Rgb{0.5f}, images);
  if (a.texture >= 0 || b.texture >= 0 || amount.texture >= 0) return false;
  texture.value = {a.value * (1 - amount.value.r) + b.value * amount.value.r, no_texture};
  return true;
}

void PbrtTextures::make_mean(Named& texture) {
  scene_.warnings.add("texture \"" + texture.kind + "\" is not supported: shown as one colour");
  texture.params.ignore_all();
  texture.value = {Rgb{0.5f}, no_texture};
}

ColorInput PbrtTextures::color(const PbrtParams& params, std::string_view name, Rgb fallback) {
  const PbrtParam* param = params.find(name);
  if (!param) return {fallback, no_texture};
  if (param->type != PbrtType::texture)
    return {reflectance_value(*param, spectrum_context()), no_texture};
  size_t images = 0;
  return argument(params, name, false, fallback, images);
}

FloatInput PbrtTextures::real(const PbrtParams& params, std::string_view name, float fallback) {
  size_t images = 0;
  const ColorInput value = argument(params, name, true, Rgb{fallback}, images);
  return {value.value.r, value.texture, 0};
}

}  // namespace troffer
