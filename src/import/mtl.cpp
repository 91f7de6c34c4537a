#include "import/mtl.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <utility>

#include "base/units.h"
#include "import/file.h"
#include "import/text_lines.h"
#include "import/two_widths.h"

namespace troffer {

namespace {

// Finite, for values that a material cannot do without.
float finite_number(TextLines& lines) {
  const float value = lines.number();
  if (!std::isfinite(value)) lines.fail("not finite");
  return value;
}

// "r", "r g b", or one of the unsupported forms "spectral FILE" and "xyz x y z".
bool read_color(TextLines& lines, Rgb& color, WarningLog& warnings) {
  if (!lines.has_word()) lines.fail("a colour is missing");
  if (lines.peek() == 's' || lines.peek() == 'x') {
    warnings.add("MTL: spectral and xyz colours are not supported: ignored");
    return false;
  }
  const float r = finite_number(lines);
  if (!lines.has_word()) {
    color = Rgb{r};
  } else {
    const float g = finite_number(lines);
    color = {r, g, lines.has_word() ? finite_number(lines) : g};
  }
  if (color.r < 0 || color.g < 0 || color.b < 0) {
    warnings.add("MTL: negative colours are set to 0");
    color = {std::max(color.r, 0.0f), std::max(color.g, 0.0f), std::max(color.b, 0.0f)};
  }
  return true;
}

// Options of maps and how many words they take; 'n' numbers: up to three.
struct MapOption {
  std::string_view name;
  int words;  // -1: one to three numbers
};
constexpr std::array map_options{
    MapOption{"-blendu", 1}, MapOption{"-blendv", 1},     MapOption{"-boost", 1},
    MapOption{"-mm", 2},     MapOption{"-o", -1},         MapOption{"-s", -1},
    MapOption{"-t", -1},     MapOption{"-texres", 1},     MapOption{"-clamp", 1},
    MapOption{"-bm", 1},     MapOption{"-imfchan", 1},    MapOption{"-type", 1},
    MapOption{"-cc", 1},     MapOption{"-colorspace", 1},
};

const MapOption* find_option(std::string_view word) {
  for (const MapOption& option : map_options)
    if (option.name == word) return &option;
  return nullptr;
}

bool starts_number(TextLines& lines) {
  if (!lines.has_word()) return false;
  const char c = lines.peek();
  return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.';
}

// One to three numbers; those not given stay as they are. A file name may follow that begins with
// a digit, so words that are not wholly numbers end the list.
Vec2 read_vector(TextLines& lines, Vec2 value) {
  for (size_t i = 0; i < 3 && starts_number(lines); ++i) {
    TextLines ahead = lines;
    const std::string_view word = ahead.word();
    if (word.find_first_not_of("0123456789+-.eE") != std::string_view::npos) break;
    const float number = finite_number(lines);
    if (i < 2) value[i] = number;
  }
  return value;
}

float strength_of(std::string_view word) {
  const float v = std::strtof(std::string(word).c_str(), nullptr);
  return std::isfinite(v) ? v : 1.0f;
}

void read_option(TextLines& lines, const MapOption& option, MtlMap& map) {
  if (option.name == "-o") {
    map.offset = read_vector(lines, map.offset);
  } else if (option.name == "-s") {
    map.scale = read_vector(lines, map.scale);
  } else if (option.words < 0) {
    read_vector(lines, {});
  } else {
    for (int i = 0; i < option.words; ++i) {
      const std::string_view word = lines.word();
      if (option.name == "-clamp") map.is_clamped = word == "on";
      if (option.name == "-bm") map.strength = strength_of(word);
    }
  }
}

// Options, then the file name, which may contain blanks and may be followed by options again.
MtlMap read_map(TextLines& lines, const std::string& subfolder) {
  MtlMap map;
  std::string name;
  while (lines.has_word()) {
    TextLines before = lines;
    const std::string_view word = lines.word();
    if (const MapOption* option = find_option(word)) {
      read_option(lines, *option, map);
      continue;
    }
    // Blanks within a name are kept as they are only where no option follows.
    const std::string_view rest = before.rest();
    if (name.empty() && rest.find(" -") == std::string_view::npos) {
      name = std::string(rest);
      break;
    }
    if (!name.empty()) name += ' ';
    name += std::string(word);
  }
  std::replace(name.begin(), name.end(), '\\', '/');
  if (!name.empty()) map.file = name.front() == '/' ? name : subfolder + name;
  return map;
}

class MtlReader {
 public:
  MtlReader(const std::string& path, std::string_view text, const std::string& subfolder,
            MtlLibrary& library, WarningLog& warnings)
      : lines_(path, text), subfolder_(subfolder), library_(library), warnings_(warnings) {}
  void read();

 private:
  TextLines lines_;
  const std::string& subfolder_;
  MtlLibrary& library_;
  WarningLog& warnings_;

  bool read_value(std::string_view keyword, MtlMaterial& m);
  bool read_share(std::string_view keyword, MtlMaterial& m);
  bool read_image(std::string_view keyword, MtlMaterial& m);
};

bool MtlReader::read_value(std::string_view keyword, MtlMaterial& m) {
  Rgb color;
  if (keyword == "Kd") {
    if (read_color(lines_, color, warnings_)) m.diffuse = color;
  } else if (keyword == "Ks") {
    if (read_color(lines_, color, warnings_)) m.specular = color;
  } else if (keyword == "Ke") {
    if (read_color(lines_, color, warnings_)) m.emission = color;
  } else if (keyword == "Tf") {
    if (read_color(lines_, color, warnings_)) m.filter = color;
  } else if (keyword == "Ns") {
    m.exponent = std::max(finite_number(lines_), 0.0f);
  } else if (keyword == "Ni") {
    m.ior = finite_number(lines_);
  } else if (keyword == "d") {
    if (lines_.has_word() && lines_.peek() == '-') lines_.word();  // -halo
    m.opacity = std::clamp(finite_number(lines_), 0.0f, 1.0f);
  } else if (keyword == "Tr") {
    m.opacity = 1 - std::clamp(finite_number(lines_), 0.0f, 1.0f);
  } else if (keyword == "illum") {
    m.illumination = int(std::clamp(finite_number(lines_), 0.0f, 10.0f));
  } else {
    return read_share(keyword, m);
  }
  return true;
}

// From 0 to 1.
bool MtlReader::read_share(std::string_view keyword, MtlMaterial& m) {
  using Share = std::pair<std::string_view, float MtlMaterial::*>;
  constexpr std::array<Share, 5> shares{{{"Pc", &MtlMaterial::coat},
                                         {"Pcr", &MtlMaterial::coat_roughness},
                                         {"Ps", &MtlMaterial::sheen},
                                         {"aniso", &MtlMaterial::anisotropy},
                                         {"anisor", &MtlMaterial::turn}}};
  const auto share = std::find_if(shares.begin(), shares.end(),
                                  [&](const Share& s) { return s.first == keyword; });
  if (share == shares.end() && keyword != "Pr" && keyword != "Pm") return false;
  const float value = std::clamp(finite_number(lines_), 0.0f, 1.0f);
  if (share != shares.end())
    m.*(share->second) = value;
  else
    (keyword == "Pr" ? m.roughness : m.metallic) = value;
  return true;
}

bool MtlReader::read_image(std::string_view keyword, MtlMaterial& m) {
  MtlMap* map = keyword == "map_Kd"                        ? &m.map_diffuse
                : keyword == "map_Ks"                      ? &m.map_specular
                : keyword == "map_Ke"                      ? &m.map_emission
                : keyword == "map_d" || keyword == "map_D" ? &m.map_opacity
                : keyword == "map_Pr"                      ? &m.map_roughness
                : keyword == "map_Pm"                      ? &m.map_metallic
                : keyword == "norm" || keyword == "map_Kn" ? &m.map_normal
                : keyword == "bump" || keyword == "map_bump" || keyword == "map_Bump" ? &m.map_bump
                                                                                      : nullptr;
  if (map) *map = read_map(lines_, subfolder_);
  return map != nullptr;
}

void MtlReader::read() {
  MtlMaterial* current = nullptr;
  while (lines_.next_line()) {
    const std::string_view keyword = lines_.word();
    if (keyword.empty()) continue;
    if (keyword == "newmtl") {
      const std::string name(lines_.rest());
      current = &library_[name];
      *current = MtlMaterial();
      current->name = name;
      continue;
    }
    // What concerns ambient light and old renderers needs no mention.
    if (keyword == "Ka" || keyword == "map_Ka" || keyword == "Kt" || keyword == "sharpness" ||
        keyword == "map_aat")
      continue;
    if (!current)
      warnings_.add("MTL: '" + std::string(keyword.substr(0, 40)) + "' before newmtl is ignored");
    else if (!read_value(keyword, *current) && !read_image(keyword, *current))
      warnings_.add("MTL: '" + std::string(keyword.substr(0, 40)) + "' is not supported: ignored");
  }
}

// An image, or no texture. OBJ's v points up.
int32_t load(const MtlMap& map, bool is_srgb, const std::string& folder, TextureLoader& loader,
             WarningLog& warnings) {
  if (map.file.empty()) return no_texture;
  Texture look;
  look.is_srgb = is_srgb;
  look.uv_scale = {map.scale.x, -map.scale.y};
  look.uv_offset = {map.offset.x, 1 - map.offset.y};
  if (map.is_clamped) look.wrap_u = look.wrap_v = WrapMode::clamp;
  const ConfinedPath path = confined_path(folder, map.file);
  std::error_code error;
  if (!path.is_fine() || !std::filesystem::exists(path.path, error)) {
    const std::string beside = path_beside(folder, map.file);
    if (!beside.empty()) {
      warnings.add("MTL: images that are not where they should be are taken from beside the scene");
      return loader.from_file(beside, look);
    }
  }
  return path.is_fine() ? loader.from_file(path.path, look)
                        : loader.missing(map.file, path.problem, look);
}

// Exporters write maps of normals as bumps: bluish where a map of heights is grey.
bool looks_like_normals(const std::vector<Texture>& textures, int32_t image) {
  const Texture& t = textures[size_t(image)];
  if (t.kind != TextureKind::image || t.channels < 3) return false;
  constexpr int steps = 16;
  Rgb sum;
  for (int y = 0; y < steps; ++y)
    for (int x = 0; x < steps; ++x) {
      const Vec2 at{(float(x) + 0.5f) / steps, (float(y) + 0.5f) / steps};
      sum += evaluate(textures, uint32_t(image), at).rgb * (1.0f / (steps * steps));
    }
  return sum.b > 0.7f && std::abs(sum.r - 0.5f) < 0.15f && std::abs(sum.g - 0.5f) < 0.15f;
}

// The format does not say how high a height of 1 is: a centimetre, times -bm.
void set_bump(const MtlMap& map, const std::string& folder, TextureLoader& loader,
              const std::vector<Texture>& textures, Material& m, WarningLog& warnings) {
  constexpr float height = 0.01f;
  const int32_t image = load(map, false, folder, loader, warnings);
  if (image == no_texture) return;
  if (looks_like_normals(textures, image)) {
    if (m.normal_texture >= 0) return;
    m.normal_texture = image;
    m.normal_scale = map.strength;
    warnings.add("MTL: a bluish bump map is read as one of normals");
  } else if (textures[size_t(image)].kind == TextureKind::image) {
    m.bump = {map.strength * height, image, 0};
    warnings.add("MTL: bump maps are approximated: a height of 1 is 1 cm times -bm");
  }
}

Rgb clamped_reflectance(Rgb c, WarningLog& warnings) {
  if (clamp01(c) != c) warnings.add("MTL: reflectance above 1 is clamped");
  return clamp01(c);
}

// Beckmann width of a Phong lobe of that exponent (Walter et al. 2007, Eq. for alpha_p).
float alpha_from_exponent(float exponent) {
  return std::sqrt(2 / (exponent + 2));
}

void set_anisotropy(const MtlMaterial& mtl, Material& m) {
  if (!(mtl.anisotropy > 0)) return;
  // The square root of Burley's ratio: roughness is squared to a width.
  const float aspect = std::pow(1 - 0.9f * mtl.anisotropy, 0.25f);
  set_two_widths(m, m.roughness.value / aspect, m.roughness.value * aspect);
  m.anisotropy_rotation_rad += 2 * pi_f * mtl.turn;
}

void set_surface(const MtlMaterial& mtl, Rgb kd, Material& m, WarningLog& warnings) {
  const float ks = max_component(mtl.specular);
  const int illum = mtl.illumination;
  m.ior = mtl.ior > 1 && mtl.ior < 10 ? mtl.ior : 1.5f;
  m.base_color.value = kd;
  m.metallic = {0, no_texture, 0};
  m.roughness = {alpha_from_exponent(mtl.exponent), no_texture, 0};
  const bool is_glass = mtl.opacity < 1 && (illum == 6 || illum == 7);
  if (mtl.roughness || mtl.metallic) {
    m.kind = MaterialKind::metallic_roughness;
    m.roughness.value = mtl.roughness.value_or(1);
    m.roughness_meaning = RoughnessMeaning::alpha_is_square;
    m.metallic.value = mtl.metallic.value_or(0);
    m.coat.value = mtl.coat;
    m.coat_roughness.value = mtl.coat_roughness;
    m.sheen_color.value = Rgb{mtl.sheen};
    m.sheen_roughness.value = m.roughness.value;
    set_anisotropy(mtl, m);
  } else if (is_glass) {
    m.kind = MaterialKind::dielectric;
    m.base_color.value = Rgb{1};
    m.roughness.value = 0;
    return;
  } else if (illum == 3 || illum == 5 || illum == 8) {
    m.kind = MaterialKind::metallic_roughness;
    m.base_color.value = clamped_reflectance(kd + mtl.specular, warnings);
    const float all = average(kd + mtl.specular);
    m.metallic.value = all > 0 ? average(mtl.specular) / all : 0;
    // Mirrors without an exponent are perfect ones.
    if (mtl.exponent == 0 || illum == 3 || illum == 5) m.roughness.value = 0;
  } else if (ks > 0 && (illum == 2 || illum < 0 || illum > 3)) {
    m.kind = MaterialKind::metallic_roughness;
    m.specular.value = std::min(ks, 1.0f);
    m.specular_color.value = mtl.specular * (1 / ks);
  }
  if (mtl.opacity < 1) {
    m.kind = MaterialKind::metallic_roughness;
    m.is_thin = true;
    m.transmission.value = 1 - mtl.opacity;
    if (!mtl.roughness) m.roughness.value = 0;  // dissolved is not frosted
    // One colour is for what goes through and for what does not: that of the larger part.
    if (mtl.filter && mtl.opacity < 0.5f && !mtl.filter->is_black())
      m.base_color.value = clamp01(*mtl.filter);
  }
}

}  // namespace

void read_mtl(const std::string& path, const std::string& subfolder, MtlLibrary& library,
              WarningLog& warnings) {
  const std::string text = as_utf8(read_text_file(path, uint64_t(1) << 28));
  MtlReader(path, text, subfolder, library, warnings).read();
}

MtlConverted convert_mtl(const MtlMaterial& mtl, const std::string& folder, TextureLoader& loader,
                         const std::vector<Texture>& textures, WarningLog& warnings) {
  MtlConverted out;
  Material& m = out.material;
  m.name = mtl.name;
  const bool has_image = !mtl.map_diffuse.file.empty();
  Rgb kd = mtl.diffuse.value_or(has_image ? Rgb{1} : Rgb{0.5f});
  if (has_image && kd.is_black()) kd = Rgb{1};
  set_surface(mtl, clamped_reflectance(kd, warnings), m, warnings);
  m.base_color.texture = load(mtl.map_diffuse, true, folder, loader, warnings);
  if (m.kind == MaterialKind::metallic_roughness && !mtl.roughness && !mtl.metallic)
    m.specular_color.texture = load(mtl.map_specular, true, folder, loader, warnings);
  m.roughness.texture = load(mtl.map_roughness, false, folder, loader, warnings);
  m.metallic.texture = load(mtl.map_metallic, false, folder, loader, warnings);
  m.normal_texture = load(mtl.map_normal, false, folder, loader, warnings);
  set_bump(mtl.map_bump, folder, loader, textures, m, warnings);
  if (!mtl.map_opacity.file.empty()) {
    m.is_alpha_masked = m.is_alpha_blended = true;
    // The image of the colour itself holds opacity in its alpha channel.
    const bool is_color_image = mtl.map_opacity.file == mtl.map_diffuse.file;
    m.alpha = {1, load(mtl.map_opacity, false, folder, loader, warnings), is_color_image ? 3 : 0};
  }
  const bool is_imaged = !mtl.map_emission.file.empty();
  out.emission = mtl.emission.value_or(is_imaged ? Rgb{1} : Rgb{0});
  if (!out.emission.is_black())
    out.emission_texture = load(mtl.map_emission, true, folder, loader, warnings);
  else if (is_imaged)
    warnings.add("MTL: map_Ke with a Ke of 0 is ignored");
  return out;
}

}  // namespace troffer
