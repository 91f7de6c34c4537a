// Procedural patterns and noise (part of PbrtTextures).
#include <algorithm>

#include "import/pbrt/pbrt_texture.h"

namespace troffer {

namespace {

constexpr int most_octaves = 16;

Vec3d vector_of(const PbrtParams& params, std::string_view name, const Vec3d& fallback) {
  const std::vector<double>& v = params.numbers(name, PbrtType::vector3);
  return v.size() == 3 ? Vec3d{v[0], v[1], v[2]} : fallback;
}

}  // namespace

// Reads how a texture maps (u,v) or a position in space to its own coordinates.
void PbrtTextures::read_mapping(const Named& texture, bool is_solid, Texture& look) {
  const PbrtParams& params = texture.params;
  const std::string mapping = is_solid ? "" : params.get_string("mapping", "uv");
  if (mapping == "uv") {
    look.uv_scale = {float(params.get_float("uscale", 1)), float(params.get_float("vscale", 1))};
    look.uv_offset = {float(params.get_float("udelta", 0)), float(params.get_float("vdelta", 0))};
    return;
  }
  look.mapping = is_solid                   ? TextureMapping::solid
                 : mapping == "spherical"   ? TextureMapping::spherical
                 : mapping == "cylindrical" ? TextureMapping::cylindrical
                                            : TextureMapping::planar;
  if (look.mapping == TextureMapping::planar && mapping != "planar")
    scene_.warnings.add(params.owner + ": mapping \"" + mapping + "\" is unknown; read as planar");
  if (texture.world_from_texture.determinant() == 0)
    scene_.warnings.add(params.owner + ": a transform without inverse is ignored");
  else
    look.from_scene = inverse(texture.world_from_texture);
  look.from_scene = look.from_scene * Affine::translate(scene_.origin);
  if (look.mapping != TextureMapping::planar) return;
  const Vec3d s = vector_of(params, "v1", {1, 0, 0}), t = vector_of(params, "v2", {0, 1, 0});
  Affine plane;
  for (size_t a = 0; a < 3; ++a) plane.columns[a] = {s[a], t[a], 0};
  plane.translation = {params.get_float("udelta", 0), params.get_float("vdelta", 0), 0};
  look.from_scene = plane * look.from_scene;
}

void PbrtTextures::set_operands(Named& texture, std::string_view first, std::string_view second,
                                Texture& pattern) {
  const bool is_mix = pattern.kind == TextureKind::mix;
  const ColorInput a =
      argument(texture.params, first, texture.is_float, Rgb{is_mix ? 0.0f : 1.0f}, texture.images);
  const ColorInput b =
      argument(texture.params, second, texture.is_float, Rgb{is_mix ? 1.0f : 0.0f}, texture.images);
  pattern.first = {a.value, a.texture};
  pattern.second = {b.value, b.texture};
}

bool PbrtTextures::make_pattern(Named& texture, const std::string& name) {
  const PbrtParams& params = texture.params;
  const std::string& kind = texture.kind;
  Texture t;
  t.name = name;
  t.octaves = std::clamp(params.get_int("octaves", 8), 0, most_octaves);
  t.persistence = float(std::clamp(params.get_float("roughness", 0.5), 0.0, 1.0));
  if (kind == "checkerboard") {
    t.kind = TextureKind::checks;
    read_mapping(texture, params.get_int("dimension", 2) == 3, t);
    set_operands(texture, "tex1", "tex2", t);
  } else if (kind == "dots") {
    t.kind = TextureKind::dots;
    read_mapping(texture, false, t);
    set_operands(texture, "inside", "outside", t);
  } else if (kind == "mix") {
    t.kind = TextureKind::mix;
    set_operands(texture, "tex1", "tex2", t);
    const ColorInput amount = argument(params, "amount", true, Rgb{0.5f}, texture.images);
    t.amount = {amount.value, amount.texture};
  } else if (kind == "directionmix") {
    t.kind = TextureKind::mix;
    set_operands(texture, "tex1", "tex2", t);
    t.amount = {Rgb{0.5f}, no_texture};
    params.ignore({"dir"});
    scene_.warnings.add("texture \"directionmix\": shown as half of each in all directions");
  } else if (kind == "fbm" || kind == "wrinkled" || kind == "windy" || kind == "marble") {
    t.kind = kind == "fbm"        ? TextureKind::fbm
             : kind == "wrinkled" ? TextureKind::wrinkled
             : kind == "windy"    ? TextureKind::windy
                                  : TextureKind::marble;
    read_mapping(texture, true, t);
    if (kind == "marble") {
      t.scale = float(params.get_float("scale", 1));
      t.variation = float(params.get_float("variation", 0.2));
      scene_.warnings.add("texture \"marble\": its colours are approximated");
    }
  } else {
    return false;
  }
  texture.images = std::max<size_t>(texture.images, 1);
  texture.value = {Rgb{1}, int32_t(scene_.textures.size())};
  scene_.textures.push_back(std::move(t));
  return true;
}

}  // namespace troffer
