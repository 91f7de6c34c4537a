#include "import/mitsuba/mitsuba_values.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "base/units.h"
#include "import/file.h"
#include "import/mitsuba/mitsuba_spectrum.h"
#include "import/mitsuba/mitsuba_transform.h"

namespace troffer {

namespace {

bool is_separator(char c) {
  return c == ' ' || c == ',' || c == '\t' || c == '\n' || c == '\r' || c == ';';
}

const std::string& value_of(const MitsubaNode& node) {
  return node.attribute("value");
}

double number_of(const MitsubaNode& node, const std::string& text) {
  const std::vector<double> numbers = numbers_of(node, text);
  if (numbers.size() != 1) node.place.fail("one number expected, not '" + shortened(text) + "'");
  return numbers[0];
}

[[noreturn]] void fail_kind(const MitsubaNode& node, const char* wanted) {
  node.place.fail("parameter '" + shortened(node.name) + "': " + wanted + " expected, not <" +
                  shortened(node.tag) + ">");
}

Rgb not_negative(const MitsubaNode& node, Rgb c, WarningLog& warnings) {
  if (!is_finite(c)) node.place.fail("a colour is out of range");
  if (c.r < 0 || c.g < 0 || c.b < 0) warnings.add("colours below 0 are set to 0");
  return {std::max(c.r, 0.0f), std::max(c.g, 0.0f), std::max(c.b, 0.0f)};
}

Rgb rgb_from_text(const MitsubaNode& node, const std::string& text) {
  if (text.starts_with('#') && text.size() == 7) {
    std::array<float, 3> c{};
    for (size_t i = 0; i < 3; ++i) {
      int byte = 0;
      const char* const begin = text.data() + 1 + 2 * i;
      if (std::from_chars(begin, begin + 2, byte, 16).ptr != begin + 2)
        node.place.fail("'" + text + "' is not a colour");
      c[i] = linear_from_srgb(float(byte) / 255);
    }
    return {c[0], c[1], c[2]};
  }
  const std::vector<double> n = numbers_of(node, text);
  if (n.size() == 1) return Rgb{float(n[0])};
  if (n.size() != 3) node.place.fail("a colour has one number or three");
  return {float(n[0]), float(n[1]), float(n[2])};
}

SampledSpectrum spectrum_from_numbers(const MitsubaNode& node, const std::vector<double>& n) {
  if (n.empty() || n.size() % 2 != 0)
    node.place.fail("a spectrum needs pairs of wavelength and value");
  SampledSpectrum s;
  for (size_t i = 0; i < n.size(); i += 2) {
    if (i > 0 && !(n[i] > n[i - 2])) node.place.fail("wavelengths must ascend");
    s.wavelengths_nm.push_back(n[i]);
    s.values.push_back(n[i + 1]);
  }
  return s;
}

// Reads lines of wavelength and value; # begins a comment.
SampledSpectrum spectrum_file(const MitsubaNode& node, const std::string& folder) {
  const std::string& name = node.attribute("filename");
  const ConfinedPath path = confined_path(folder, name);
  if (!path.is_fine()) node.place.fail("cannot use '" + shortened(name) + "': " + path.problem);
  std::string text = read_text_file(path.path, max_spectrum_file_bytes);
  bool is_comment = false;
  for (char& c : text) {
    is_comment = c == '#' || (is_comment && c != '\n');
    if (is_comment) c = ' ';
  }
  return spectrum_from_numbers(node, numbers_of(node, text));
}

// Returns nothing if the spectrum is one number for all wavelengths.
std::optional<SampledSpectrum> sampled(const MitsubaNode& node, const std::string& folder) {
  if (node.has("filename")) return spectrum_file(node, folder);
  std::string text = value_of(node);
  if (text.find(':') == std::string::npos) {
    if (!node.has("wavelengths")) return std::nullopt;
    return spectrum_from_pairs(node, numbers_of(node, node.attribute("wavelengths")),
                               numbers_of(node, node.attribute("values")));
  }
  std::replace(text.begin(), text.end(), ':', ' ');
  return spectrum_from_numbers(node, numbers_of(node, text));
}

Rgb blackbody(const MitsubaNode& node) {
  const std::string& given = node.attribute("temperature");
  std::string text = given.empty() ? value_of(node) : given;
  if (!text.empty() && (text.back() == 'K' || text.back() == 'k')) text.pop_back();
  const double scale = node.has("scale") ? number_of(node, node.attribute("scale")) : 1;
  return blackbody_color(node, number_of(node, text)) * float(scale);
}

struct NamedIndex {
  std::string_view name;
  double index;
};
// Indices of refraction at the sodium line, from physics tables.
constexpr std::array named_indices{
    NamedIndex{"vacuum", 1.0},
    NamedIndex{"helium", 1.000036},
    NamedIndex{"hydrogen", 1.000132},
    NamedIndex{"air", 1.000277},
    NamedIndex{"carbon dioxide", 1.00045},
    NamedIndex{"water", 1.333},
    NamedIndex{"acetone", 1.36},
    NamedIndex{"ethanol", 1.361},
    NamedIndex{"carbon tetrachloride", 1.461},
    NamedIndex{"glycerol", 1.4729},
    NamedIndex{"benzene", 1.501},
    NamedIndex{"silicone oil", 1.52045},
    NamedIndex{"bromine", 1.661},
    NamedIndex{"water ice", 1.31},
    NamedIndex{"fused quartz", 1.458},
    NamedIndex{"pyrex", 1.47},
    NamedIndex{"acrylic glass", 1.49},
    NamedIndex{"polypropylene", 1.49},
    NamedIndex{"bk7", 1.5046},
    NamedIndex{"sodium chloride", 1.544},
    NamedIndex{"amber", 1.55},
    NamedIndex{"pet", 1.575},
    NamedIndex{"diamond", 2.419},
};

}  // namespace

const MitsubaNode* find_parameter(const MitsubaNode& plugin, std::string_view name) {
  for (const MitsubaNode* child : plugin.children) {
    if (child->name != name) continue;
    child->is_used = true;
    return child;
  }
  return nullptr;
}

const MitsubaNode* find_parameter(const MitsubaNode& plugin,
                                  std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names)
    if (const MitsubaNode* found = find_parameter(plugin, name)) return found;
  return nullptr;
}

std::vector<double> numbers_of(const MitsubaNode& node, const std::string& text) {
  std::vector<double> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (true) {
    while (at < end && is_separator(*at)) ++at;
    if (at == end) return numbers;
    if (*at == '+') ++at;
    double value = 0;
    const auto result = std::from_chars(at, end, value);
    // Some writers append the f of C's float literals.
    const char* const next = result.ptr < end && *result.ptr == 'f' ? result.ptr + 1 : result.ptr;
    if (result.ec != std::errc() || !std::isfinite(value) || (next < end && !is_separator(*next)))
      node.place.fail("'" + shortened(std::string(at, end)) + "' is not a number");
    numbers.push_back(value);
    at = next;
  }
}

double get_number(const MitsubaNode& plugin, std::string_view name, double fallback) {
  const MitsubaNode* p = find_parameter(plugin, name);
  if (!p) return fallback;
  if (p->tag != "float" && p->tag != "integer" && p->tag != "spectrum") fail_kind(*p, "a number");
  return number_of(*p, value_of(*p));
}

int get_integer(const MitsubaNode& plugin, std::string_view name, int fallback) {
  const double value = get_number(plugin, name, fallback);
  if (std::abs(value) > 1e9 || value != std::floor(value))
    plugin.place.fail("parameter '" + std::string(name) + "' is not an integer");
  return int(value);
}

bool get_flag(const MitsubaNode& plugin, std::string_view name, bool fallback) {
  const MitsubaNode* p = find_parameter(plugin, name);
  if (!p) return fallback;
  const std::string& v = value_of(*p);
  if (v == "true" || v == "True" || v == "1") return true;
  if (v == "false" || v == "False" || v == "0") return false;
  p->place.fail("parameter '" + shortened(p->name) + "': true or false expected");
}

std::string get_text(const MitsubaNode& plugin, std::string_view name,
                     const std::string& fallback) {
  const MitsubaNode* p = find_parameter(plugin, name);
  if (!p) return fallback;
  if (!p->has("value")) fail_kind(*p, "a <string>");
  return value_of(*p);
}

std::optional<Vec3d> get_vector(const MitsubaNode& plugin, std::string_view name) {
  const MitsubaNode* p = find_parameter(plugin, name);
  if (!p) return std::nullopt;
  return vector_attribute(*p, Vec3d{0});
}

Affine get_transform(const MitsubaNode& plugin, std::string_view name) {
  const MitsubaNode* p = find_parameter(plugin, name);
  if (!p) return {};
  if (p->tag != "transform" && p->tag != "animation") fail_kind(*p, "a <transform>");
  return transform_of(*p);
}

Rgb blackbody_color(const MitsubaNode& node, double kelvin) {
  if (!(kelvin >= 100 && kelvin <= 1e6))
    node.place.fail("a temperature must lie between 100 and 1 000 000 K");
  return mitsuba_blackbody(kelvin);
}

SampledSpectrum spectrum_from_pairs(const MitsubaNode& node, const std::vector<double>& at,
                                    const std::vector<double>& values) {
  if (at.size() != values.size()) node.place.fail("as many values as wavelengths expected");
  std::vector<double> pairs;
  for (size_t i = 0; i < at.size(); ++i) pairs.insert(pairs.end(), {at[i], values[i]});
  return spectrum_from_numbers(node, pairs);
}

bool is_color(const MitsubaNode& node) {
  for (const char* tag : {"rgb", "srgb", "spectrum", "xyz", "blackbody", "float", "integer"})
    if (node.tag == tag) return true;
  return false;
}

Rgb color_of(const MitsubaNode& node, const std::string& folder, WarningLog& warnings,
             SpectrumUse use) {
  if (node.tag == "blackbody") return blackbody(node);
  const std::string& text = value_of(node);
  if (node.tag == "float" || node.tag == "integer")
    return not_negative(node, Rgb{float(number_of(node, text))}, warnings);
  if (node.tag == "rgb" || (node.tag == "spectrum" && text.starts_with('#')))
    return not_negative(node, rgb_from_text(node, text), warnings);
  if (node.tag == "srgb") {
    const Rgb c = rgb_from_text(node, text);
    if (text.starts_with('#')) return c;  // already linear
    return not_negative(node, {linear_from_srgb(c.r), linear_from_srgb(c.g), linear_from_srgb(c.b)},
                        warnings);
  }
  if (node.tag == "xyz") {
    const Rgb c = rgb_from_text(node, text);
    return not_negative(node,
                        {3.2404542f * c.r - 1.5371385f * c.g - 0.4985314f * c.b,
                         -0.9692660f * c.r + 1.8760108f * c.g + 0.0415560f * c.b,
                         0.0556434f * c.r - 0.2040259f * c.g + 1.0572252f * c.b},
                        warnings);
  }
  if (node.tag != "spectrum") fail_kind(node, "a colour");
  const auto spectrum = sampled(node, folder);
  if (spectrum) return mitsuba_color(*spectrum, use);
  const Rgb c = rgb_from_text(node, text);
  const bool is_uniform = c.r == c.g && c.g == c.b;
  return not_negative(node, is_uniform ? mitsuba_color(double(c.r), use) : c, warnings);
}

Rgb metal_index_of(const MitsubaNode& node, const std::string& folder) {
  if (node.tag == "spectrum")
    if (const auto spectrum = sampled(node, folder))
      return mitsuba_color(*spectrum, SpectrumUse::factor);
  const Rgb c = rgb_from_text(node, value_of(node));
  return {std::max(c.r, 0.0f), std::max(c.g, 0.0f), std::max(c.b, 0.0f)};
}

double index_of_refraction(const MitsubaNode& plugin, std::string_view name,
                           const std::string& fallback) {
  const MitsubaNode* p = find_parameter(plugin, name);
  std::string text = p ? value_of(*p) : fallback;
  if (p && p->tag == "spectrum" && text.find(':') != std::string::npos)
    return value_at(*sampled(*p, ""), sodium_nm);
  if (p && p->tag != "string") {
    const double index = number_of(*p, text);
    if (!(index > 0 && index < 1e6)) p->place.fail("an index of refraction must be positive");
    return index;
  }
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
  for (const NamedIndex& row : named_indices)
    if (row.name == text) return row.index;
  (p ? p : &plugin)->place.fail("no index of refraction is known for '" + shortened(text) + "'");
}

void warn_of_unused(const MitsubaNode& plugin, WarningLog& warnings) {
  for (const MitsubaNode* child : plugin.children)
    if (!child->is_used)
      warnings.add(plugin.tag + " \"" + shortened(plugin.type) + "\": " +
                   (child->name.empty() ? "<" + shortened(child->tag) + ">"
                                        : "'" + shortened(child->name) + "'") +
                   " is not used");
}

}  // namespace troffer
