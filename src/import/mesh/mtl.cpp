#include "import/mesh/mtl.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>
#include <vector>

#include "import/file.h"
#include "import/text_lines.h"

namespace troffer {

namespace {

// Reads a number that must be finite.
float finite_number(TextLines& lines) {
  const float value = lines.number();
  if (!std::isfinite(value)) lines.fail("not finite");
  return value;
}

// Reads "r" or "r g b". Returns false, with a warning, for the unsupported forms "spectral FILE"
// and "xyz x y z".
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

// An option of a map, and the number of words that it takes.
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

// Reads one to three numbers; missing ones keep their value. The list ends at a word that is not
// entirely numeric, because a file name that begins with a digit may follow.
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

float number_or(std::string_view word, float fallback) {
  const std::string text(word);
  char* end = nullptr;
  const float v = std::strtof(text.c_str(), &end);
  return std::isfinite(v) && end != text.c_str() ? v : fallback;
}

// Applies the i-th word after an option.
void set_option(std::string_view name, int i, std::string_view word, MtlMap& map) {
  constexpr std::string_view channels = "rgbml";
  if (name == "-clamp") map.is_clamped = word == "on";
  if (name == "-bm") map.strength = number_or(word, 1);
  if (name == "-mm") (i == 0 ? map.base : map.gain) = number_or(word, float(i));
  if (name == "-imfchan" && word.size() == 1 && channels.find(word[0]) != std::string_view::npos)
    map.channel = word[0];
  if (name == "-colorspace") map.is_linear = word == "linear";
}

void read_option(TextLines& lines, const MapOption& option, MtlMap& map) {
  if (option.name == "-o") {
    map.offset = read_vector(lines, map.offset);
  } else if (option.name == "-s") {
    map.scale = read_vector(lines, map.scale);
  } else if (option.name == "-t") {
    const Vec2 t = read_vector(lines, {});
    map.is_turbulent = t.x != 0 || t.y != 0;
  } else {
    for (int i = 0; i < option.words; ++i) set_option(option.name, i, lines.word(), map);
  }
}

// Reads options and the file name. The name may contain blanks, and more options may follow it.
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
    // Keep the blanks within a name exactly, unless options follow.
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
      : lines_(path, text),
        is_of_blender_(text.substr(0, text.find('\n')).find("# Blender") != std::string_view::npos),
        subfolder_(subfolder),
        library_(library),
        warnings_(warnings) {}
  void read();

 private:
  TextLines lines_;
  bool is_of_blender_;
  const std::string& subfolder_;
  MtlLibrary& library_;
  WarningLog& warnings_;

  bool read_value(std::string_view keyword, MtlMaterial& m);
  bool read_share(std::string_view keyword, MtlMaterial& m);
  bool read_image(std::string_view keyword, MtlMaterial& m);
  void fix_inverted_opacity(const std::vector<std::string>& names);
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
    m.has_dissolve = true;
  } else if (keyword == "Tr") {  // some programs write Tr 1 for opaque materials
    const float through = std::clamp(finite_number(lines_), 0.0f, 1.0f);
    if (!m.has_dissolve) m.opacity = 1 - through;
  } else if (keyword == "illum") {
    m.illumination = int(std::clamp(finite_number(lines_), 0.0f, 10.0f));
  } else {
    return read_share(keyword, m);
  }
  return true;
}

// Reads a statement whose value lies in [0,1].
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
                : keyword == "map_Ns"                      ? &m.map_exponent
                : keyword == "norm" || keyword == "map_Kn" ? &m.map_normal
                : keyword == "bump" || keyword == "map_bump" || keyword == "map_Bump" ? &m.map_bump
                                                                                      : nullptr;
  if (map) *map = read_map(lines_, subfolder_);
  return map != nullptr;
}

// Sets d 0 to opaque if most materials, or ones with an image, have it: some programs invert d, and
// everything would be invisible.
void MtlReader::fix_inverted_opacity(const std::vector<std::string>& names) {
  const auto is_unseen = [&](const std::string& name) { return library_[name].opacity == 0; };
  const auto unseen = std::count_if(names.begin(), names.end(), is_unseen);
  const bool are_most = 2 * unseen > std::ptrdiff_t(names.size()) && names.size() > 1;
  for (const std::string& name : names) {
    const bool is_pictured = !library_[name].map_diffuse.file.empty();
    if (!is_unseen(name) || !(are_most || is_pictured)) continue;
    library_[name].opacity = 1;
    warnings_.add(
        "MTL: d 0 is read as opaque for materials with images, or if most materials have it");
  }
}

void MtlReader::read() {
  MtlMaterial* current = nullptr;
  std::vector<std::string> names;
  while (lines_.next_line()) {
    const std::string_view keyword = lines_.word();
    if (keyword.empty()) continue;
    if (keyword == "newmtl") {
      const std::string name(lines_.rest());
      current = &library_[name];
      *current = MtlMaterial();
      current->name = name;
      current->is_of_blender = is_of_blender_;
      names.push_back(name);
      continue;
    }
    // Ambient light and options of old renderers need no warning.
    if (keyword == "Ka" || keyword == "map_Ka" || keyword == "Kt" || keyword == "sharpness" ||
        keyword == "map_aat")
      continue;
    if (!current)
      warnings_.add("MTL: '" + std::string(keyword.substr(0, 40)) + "' before newmtl is ignored");
    else if (!read_value(keyword, *current) && !read_image(keyword, *current))
      warnings_.add("MTL: '" + std::string(keyword.substr(0, 40)) + "' is not supported: ignored");
  }
  fix_inverted_opacity(names);
}

}  // namespace

void read_mtl(const std::string& path, const std::string& subfolder, MtlLibrary& library,
              WarningLog& warnings) {
  const std::string text = as_utf8(read_text_file(path, uint64_t(1) << 28));
  MtlReader(path, text, subfolder, library, warnings).read();
}

}  // namespace troffer
