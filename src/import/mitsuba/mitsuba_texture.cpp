#include "import/mitsuba/mitsuba_texture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/coat.h"
#include "import/file.h"
#include "import/mitsuba/mitsuba_transform.h"
#include "import/mitsuba/mitsuba_values.h"

namespace troffer {

namespace {

constexpr int max_texture_depth = 16;
constexpr Rgb unknown_color{0.5f};

WrapMode wrap_mode(const MitsubaNode& node, const std::string& text) {
  if (text == "repeat") return WrapMode::repeat;
  if (text == "mirror") return WrapMode::mirror;
  if (text == "clamp") return WrapMode::clamp;
  if (text == "zero") return WrapMode::black;
  if (text == "one") return WrapMode::clamp;
  node.place.fail("wrap mode '" + shortened(text) + "' is not known");
}

}  // namespace

// Starts to decode all bitmaps. Unused ones cost a little time on other cores.
MitsubaTextures::MitsubaTextures(Scene& scene, const MitsubaTree& tree)
    : scene_(scene), tree_(tree), loader_(scene) {
  if (!loader_.decodes_ahead()) return;
  for (const MitsubaNode& node : tree.all()) {
    if (node.tag != "texture" || node.type != "bitmap") continue;
    for (const MitsubaNode* child : node.children)
      if (child->name == "filename")
        if (const ConfinedPath path = tree.file(child->attribute("value")); path.is_fine())
          loader_.expect_file(path.path);
  }
}

int32_t MitsubaTextures::append(Texture texture) {
  scene_.textures.push_back(std::move(texture));
  return int32_t(scene_.textures.size()) - 1;
}

// Maps (u,v) to uv · scale + offset: to_uv of versions 2 and 3; uscale, vscale, uoffset, voffset of
// 0.x.
void MitsubaTextures::set_coordinates(const MitsubaNode& node, Texture& look) {
  const double both = get_number(node, "uvscale", 1);
  look.uv_scale = {float(get_number(node, "uscale", both)),
                   float(get_number(node, "vscale", both))};
  look.uv_offset = {float(get_number(node, "uoffset", 0)), float(get_number(node, "voffset", 0))};
  if (!find_parameter(node, "to_uv")) return;
  const Affine t = get_transform(node, "to_uv");
  const auto &x = t.columns[0], &y = t.columns[1];
  // Texture rotates after scaling: columns scale_u (cos, -sin) and scale_v (sin, cos).
  const double determinant = x.x * y.y - x.y * y.x;
  const double su = std::hypot(x.x, x.y), sv = std::copysign(std::hypot(y.x, y.y), determinant);
  look.uv_offset = {float(t.translation.x), float(t.translation.y)};
  if (x.y == 0 && y.x == 0) {
    look.uv_scale = {float(x.x), float(y.y)};
    return;
  }
  look.uv_scale = {float(su), float(sv)};
  look.uv_rotation_rad = float(std::atan2(-x.y, x.x));
  if (std::abs(x.x * y.x + x.y * y.y) > 1e-5 * su * std::abs(sv))
    scene_.warnings.add("texture \"" + shortened(node.type) +
                        "\": its to_uv shears: only rotation and scale are used");
}

int32_t MitsubaTextures::bitmap(const MitsubaNode& node) {
  Texture look;
  look.is_srgb = !get_flag(node, "raw", false);
  if (const double gamma = get_number(node, "gamma", -1); gamma > 0 && gamma != 2.2) {
    if (gamma == 1) look.is_srgb = false;
    if (gamma != 1) scene_.warnings.add("texture \"bitmap\": its gamma is read as sRGB");
  }
  look.is_filtered = get_text(node, "filter_type", "bilinear") != "nearest";
  const std::string wrap = get_text(node, "wrap_mode", "repeat");
  look.wrap_u = wrap_mode(node, get_text(node, "wrap_mode_u", wrap));
  look.wrap_v = wrap_mode(node, get_text(node, "wrap_mode_v", wrap));
  set_coordinates(node, look);
  for (const char* name : {"max_anisotropy", "cache", "format", "accel"})
    find_parameter(node, name);
  const std::string file = get_text(node, "filename", "");
  warn_of_unused(node, scene_.warnings);
  const ConfinedPath path = tree_.file(file);
  return path.is_fine() ? loader_.from_file(path.path, look)
                        : loader_.missing(shortened(file), path.problem, look);
}

Rgb MitsubaTextures::plain(const MitsubaNode& node, std::string_view name, Rgb fallback) {
  const MitsubaNode* p = find_parameter(node, name);
  if (!p) return fallback;
  const MitsubaNode& given = tree_.resolved(*p);
  if (is_color(given) && given.type.empty())
    return color_of(given, tree_.folder(), scene_.warnings, use_);
  if (given.tag == "texture" || given.tag == "spectrum") {
    const ColorInput c = texture(given);
    if (c.texture < 0) return c.value;
  }
  scene_.warnings.add("texture \"" + shortened(node.type) +
                      "\": textures within it are shown as one colour");
  return fallback;
}

// Two by two squares on [0,1]², with the first colour where both coordinates are in the same half.
// If a number is asked for, the colours swap: Mitsuba's lookups of colours and numbers differ.
ColorInput MitsubaTextures::checkerboard(const MitsubaNode& node) {
  Rgb a = plain(node, "color0", Rgb{0.4f}), b = plain(node, "color1", Rgb{0.2f});
  if (is_number_ && !tree_.is_legacy()) std::swap(a, b);
  Texture t;
  t.name = node.id;
  t.kind = TextureKind::image;
  t.width = t.height = 2;
  t.channels = 3;
  for (const Rgb& c : {a, b, b, a}) t.texels_float.insert(t.texels_float.end(), {c.r, c.g, c.b});
  t.is_srgb = t.is_filtered = false;
  set_coordinates(node, t);
  warn_of_unused(node, scene_.warnings);
  return {Rgb{1}, append(std::move(t))};
}

ColorInput MitsubaTextures::scaled(const MitsubaNode& node) {
  const Rgb factor = plain(node, "scale", Rgb{1});
  for (const MitsubaNode* child : node.children) {
    const MitsubaNode& inner = tree_.resolved(*child);
    if (inner.tag != "texture") continue;
    child->is_used = true;
    ColorInput c = texture(inner);
    c.value *= factor;
    return c;
  }
  return {factor * plain(node, "value", Rgb{1}), no_texture};
}

ColorInput MitsubaTextures::attribute(const MitsubaNode& node) {
  const std::string name = get_text(node, "name", "");
  const Rgb scale{float(get_number(node, "scale", 1))};
  warn_of_unused(node, scene_.warnings);
  if (attributes_)
    if (const auto texture = attributes_->texture(name)) return {scale, *texture};
  scene_.warnings.add("texture \"mesh_attribute\": the shape has no attribute '" + shortened(name) +
                      "': black");
  return {Rgb{0}, no_texture};
}

// Returns the colour of a spectrum plugin ([1], "Spectra"); nothing for other plugins.
std::optional<Rgb> MitsubaTextures::spectrum_plugin(const MitsubaNode& node) {
  const std::string& type = node.type;
  if (type == "uniform" || type == "srgb" || type == "constant" || type == "d65" ||
      type == "rawconstant") {
    Rgb c{1};
    if (const auto v = type == "rawconstant" ? vector_value(node) : std::nullopt)
      c = *v;
    else
      c = plain(node, "color", plain(node, "value", Rgb{1}));
    return c * plain(node, "scale", Rgb{1});
  }
  if (type == "blackbody") {
    for (const char* name : {"wavelength_min", "wavelength_max"}) find_parameter(node, name);
    return blackbody_color(node, get_number(node, "temperature", 0));
  }
  if (type != "regular" && type != "irregular") return std::nullopt;
  const auto list = [&](const char* name) {
    const MitsubaNode* p = find_parameter(node, name);
    return p ? numbers_of(*p, p->attribute("value")) : std::vector<double>();
  };
  const std::vector<double> values = list("values");
  std::vector<double> at = list("wavelengths");
  if (type == "regular") {
    const double first = get_number(node, "wavelength_min", 360);
    const double last = get_number(node, "wavelength_max", 830);
    at.clear();
    for (size_t i = 0; i < values.size(); ++i)
      at.push_back(lerp(first, last, double(i) / double(std::max<size_t>(values.size(), 2) - 1)));
  }
  return mitsuba_color(spectrum_from_pairs(node, at, values), use_);
}

std::optional<Rgb> MitsubaTextures::vector_value(const MitsubaNode& node) {
  const MitsubaNode* p = find_parameter(node, "value");
  if (!p || (p->tag != "vector" && p->tag != "point")) return std::nullopt;
  return Rgb(float(vector_attribute(*p, {}).x), float(vector_attribute(*p, {}).y),
             float(vector_attribute(*p, {}).z));
}

ColorInput MitsubaTextures::texture(const MitsubaNode& node) {
  if (++depth_ > max_texture_depth) node.place.fail("textures contain each other too deeply");
  ColorInput out{unknown_color, no_texture};
  if (node.type == "bitmap") {
    out = {Rgb{1}, bitmap(node)};
  } else if (node.type == "checkerboard") {
    out = checkerboard(node);
  } else if (node.type == "scale") {
    out = scaled(node);
  } else if (node.type == "mesh_attribute") {
    out = attribute(node);
  } else if (const auto c = spectrum_plugin(node)) {
    out.value = *c;
  } else {
    if (node.type == "gridtexture") out.value = plain(node, "color0", Rgb{0.2f});
    scene_.warnings.add("texture \"" + shortened(node.type) +
                        "\" is not supported: shown as one colour");
  }
  --depth_;
  return out;
}

ColorInput MitsubaTextures::value(const MitsubaNode& given, SpectrumUse use, bool is_number) {
  use_ = use;
  is_number_ = is_number;
  const MitsubaNode& node = tree_.resolved(given);
  if (node.tag == "texture" || (node.tag == "spectrum" && !node.type.empty())) return texture(node);
  return {color_of(node, tree_.folder(), scene_.warnings, use), no_texture};
}

ColorInput MitsubaTextures::color(const MitsubaNode& plugin,
                                  std::initializer_list<std::string_view> names, Rgb fallback) {
  const MitsubaNode* p = find_parameter(plugin, names);
  if (!p) return {fallback, no_texture};
  ColorInput c = value(*p, SpectrumUse::reflectance, false);
  if (c.texture < 0 && clamp01(c.value) != c.value) {
    scene_.warnings.add("bsdf \"" + shortened(plugin.type) + "\": '" + p->name +
                        "' above 1 is set to 1");
    c.value = clamp01(c.value);
  }
  return c;
}

FloatInput MitsubaTextures::real(const MitsubaNode& plugin,
                                 std::initializer_list<std::string_view> names, float fallback) {
  const MitsubaNode* p = find_parameter(plugin, names);
  return p ? real(*p) : FloatInput{fallback, no_texture, 0};
}

FloatInput MitsubaTextures::real(const MitsubaNode& parameter) {
  const ColorInput c = value(parameter, SpectrumUse::factor, true);
  const Rgb& v = c.value;
  const float number = v.r == v.g && v.g == v.b ? v.r : luminance(v);
  return {number, c.texture < 0 ? no_texture : with_grey_texels(c.texture), 0};
}

ColorInput MitsubaTextures::real_color(const MitsubaNode& plugin, std::string_view name) {
  const MitsubaNode* p = find_parameter(plugin, name);
  return p ? value(*p, SpectrumUse::factor, false) : ColorInput{Rgb{0}, no_texture};
}

ColorInput MitsubaTextures::color(const MitsubaNode& parameter) {
  return value(parameter, SpectrumUse::reflectance, false);
}

ColorInput MitsubaTextures::emission(const MitsubaNode& parameter) {
  return value(parameter, SpectrumUse::emission, false);
}

ColorInput MitsubaTextures::vector(const MitsubaNode& parameter) {
  return value(parameter, SpectrumUse::factor, false);
}

// Replaces colours by their luminance, for parameters that are numbers.
int32_t MitsubaTextures::with_grey_texels(int32_t index) {
  const Texture& from = scene_.textures[size_t(index)];
  if (from.kind != TextureKind::image || from.channels < 3) return index;
  const auto known = grey_.find(index);
  if (known != grey_.end()) return known->second;
  const auto channels = size_t(from.channels);
  Texture t = from;
  t.channels = 1;
  const size_t texels = size_t(t.width) * size_t(t.height);
  const auto is_grey = [&](const auto& v) {
    for (size_t i = 0; i < texels * channels; i += channels)
      if (v[i] != v[i + 1] || v[i] != v[i + 2]) return false;
    return true;
  };
  if (from.texels8.empty() ? is_grey(from.texels_float) : is_grey(from.texels8))
    return grey_[index] = index;
  std::vector<float> grey(texels);
  for (size_t i = 0; i < texels; ++i) {
    Rgb c;
    for (size_t k = 0; k < 3; ++k) {
      const size_t at = i * channels + k;
      const float v = from.texels8.empty() ? from.texels_float[at] : float(from.texels8[at]) / 255;
      c[k] = from.is_srgb && !from.texels8.empty() ? linear_from_srgb(v) : v;
    }
    grey[i] = luminance(c);
  }
  t.texels8.clear();
  t.texels_float = std::move(grey);
  t.is_srgb = false;
  return grey_[index] = append(std::move(t));
}

int32_t MitsubaTextures::with_brightened_texels(int32_t index, float f) {
  if (scene_.textures[size_t(index)].kind != TextureKind::image) return index;
  Texture t = scene_.textures[size_t(index)];
  const auto brightened = [&](float v) { return from_white_base(v, f); };
  const auto channels = size_t(t.channels);
  const bool has_alpha = channels == 2 || channels == 4;
  const auto is_alpha = [&](size_t i) { return has_alpha && i % channels == channels - 1; };
  for (size_t i = 0; i < t.texels_float.size(); ++i)
    if (!is_alpha(i)) t.texels_float[i] = brightened(std::max(t.texels_float[i], 0.0f));
  for (size_t i = 0; i < t.texels8.size(); ++i) {
    if (is_alpha(i)) continue;
    const float v = float(t.texels8[i]) / 255;
    const float out = t.is_srgb ? srgb_from_linear(brightened(linear_from_srgb(v))) : brightened(v);
    t.texels8[i] = uint8_t(std::lround(255 * std::clamp(out, 0.0f, 1.0f)));
  }
  return append(std::move(t));
}

}  // namespace troffer
