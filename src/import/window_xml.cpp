#include "import/window_xml.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <pugixml.hpp>

#include "base/error.h"
#include "import/json_location.h"
#include "import/source_place.h"
#include "import/tensor_tree.h"

namespace troffer {

namespace {

constexpr size_t most_patches = 2000;    // of a basis
constexpr double most_scattered = 1.01;  // of the light that arrives, as Radiance allows

std::string lower_case(std::string text) {
  for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

// Text without blanks at its ends.
std::string trimmed(const char* raw) {
  std::string text = raw;
  const auto is_blank = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  while (!text.empty() && is_blank(text.back())) text.pop_back();
  size_t first = 0;
  while (first < text.size() && is_blank(text[first])) ++first;
  return text.substr(first);
}

class WindowXml {
 public:
  WindowXml(const std::string& file, const std::string& text, WarningLog& warnings)
      : file_(file), text_(text), warnings_(warnings) {}
  AngularBsdf read();

 private:
  const std::string& file_;
  const std::string& text_;
  WarningLog& warnings_;
  std::map<std::string, AngleBasis> bases_{{"lbnl/klems full", klems_full()},
                                           {"lbnl/klems half", klems_half()},
                                           {"lbnl/klems quarter", klems_quarter()}};
  int tree_dimensions_ = 0;  // 0: matrices
  bool has_incident_rows_ = false;

  [[noreturn]] void fail(const pugi::xml_node& node, const std::string& what) const;
  std::string text_of(const pugi::xml_node& node, const char* child) const;
  double number_of(const pugi::xml_node& node, const char* child) const;
  void read_structure(const pugi::xml_node& definition);
  void read_basis(const pugi::xml_node& node);
  AngleMatrix read_block(const pugi::xml_node& block) const;
  AngleMatrix read_tree(const pugi::xml_node& data) const;
  void check_energy(const pugi::xml_node& block, const AngleMatrix& m) const;
  const AngleBasis& basis_of(const pugi::xml_node& block, const char* member) const;
};

void WindowXml::fail(const pugi::xml_node& node, const std::string& what) const {
  const auto offset = node.offset_debug();
  const TextPosition at = position_of_offset(text_, offset > 0 ? size_t(offset) : 0);
  throw InputError(file_, at.line, at.column, what);
}

std::string WindowXml::text_of(const pugi::xml_node& node, const char* child) const {
  const std::string text = trimmed(node.child(child).text().get());
  if (text.empty()) fail(node, fmt::format("<{}> has no <{}>", node.name(), child));
  return text;
}

double WindowXml::number_of(const pugi::xml_node& node, const char* child) const {
  const std::string text = text_of(node, child);
  double value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size() || !std::isfinite(value))
    fail(node, fmt::format("<{}>: '{}' is not a number", child, shortened(text)));
  return value;
}

void WindowXml::read_structure(const pugi::xml_node& definition) {
  const std::string given = text_of(definition, "IncidentDataStructure");
  const std::string how = lower_case(given);
  if (how == "rows")
    has_incident_rows_ = true;
  else if (how == "tensortree3" || how == "tensortree4")
    tree_dimensions_ = how.back() - '0';
  else if (how != "columns")
    fail(definition, "IncidentDataStructure '" + shortened(given) +
                         "' is not Columns, Rows, TensorTree3 or TensorTree4");
  for (const pugi::xml_node& basis : definition.children("AngleBasis")) read_basis(basis);
  if (tree_dimensions_ > 0)
    warnings_.add("a tensor tree of scattering is reduced to the 145 patches of the Klems basis");
}

void WindowXml::read_basis(const pugi::xml_node& node) {
  const std::string name = lower_case(text_of(node, "AngleBasisName"));
  if (bases_.contains(name)) return;
  std::vector<AngleBasis::Ring> rings;
  double upper = 0, patches = 0;
  for (const pugi::xml_node& block : node.children("AngleBasisBlock")) {
    const pugi::xml_node bounds = block.child("ThetaBounds");
    const double lower = rings.empty() ? 0 : number_of(bounds, "LowerTheta");
    if (std::abs(lower - upper) > 1e-4) fail(block, "the rings of the angle basis leave a gap");
    upper = number_of(bounds, "UpperTheta");
    if (!(upper > lower && upper <= 90.0001)) fail(block, "the angles of the rings do not ascend");
    const double n = number_of(block, "nPhis");
    if (!(n >= 1 && n == std::floor(n)) || (patches += n) > double(most_patches))
      fail(block, "nPhis is not a number of patches, or the basis has more than 2000");
    rings.push_back({lower, int(n)});
  }
  if (rings.empty() || upper < 89.999) fail(node, "the angle basis does not end at 90 degrees");
  bases_.emplace(name, AngleBasis(rings));
}

const AngleBasis& WindowXml::basis_of(const pugi::xml_node& block, const char* member) const {
  const std::string name = text_of(block, member);
  const auto found = bases_.find(lower_case(name));
  if (found == bases_.end()) fail(block, "no angle basis '" + shortened(name) + "' is defined");
  return found->second;
}

AngleMatrix WindowXml::read_tree(const pugi::xml_node& data) const {
  std::string problem;
  const TensorTree tree(data.text().get(), tree_dimensions_, problem);
  if (!problem.empty()) fail(data, "ScatteringData " + problem);
  return tree.reduced_to(klems_full());
}

AngleMatrix WindowXml::read_block(const pugi::xml_node& block) const {
  const pugi::xml_node data = block.child("ScatteringData");
  if (!data) fail(block, "<WavelengthDataBlock> has no <ScatteringData>");
  if (tree_dimensions_ > 0) return read_tree(data);
  AngleMatrix m;
  m.in = basis_of(block, "ColumnAngleBasis");
  m.out = basis_of(block, "RowAngleBasis");
  const size_t count = m.in.size() * m.out.size();
  m.values.resize(count);
  const char* at = data.text().get();
  const char* const end = at + std::char_traits<char>::length(at);
  const auto skip = [&] {
    while (at < end && (std::isspace(static_cast<unsigned char>(*at)) || *at == ',')) ++at;
  };
  for (size_t k = 0; k < count; ++k) {
    skip();
    if (at < end && *at == '+') ++at;
    float v = 0;
    const auto read = std::from_chars(at, end, v);
    if (read.ec != std::errc() || !std::isfinite(v))
      fail(data, fmt::format("ScatteringData has {} numbers, its bases need {}", k, count));
    at = read.ptr;
    const size_t place =
        has_incident_rows_ ? (k % m.out.size()) * m.in.size() + k / m.out.size() : k;
    m.values[place] = std::max(v, 0.0f);
  }
  skip();
  if (at != end)
    fail(data, fmt::format("ScatteringData has more than the {} numbers of its bases", count));
  return m;
}

void WindowXml::check_energy(const pugi::xml_node& block, const AngleMatrix& m) const {
  double most = 0;
  for (size_t i = 0; i < m.in.size(); ++i) most = std::max(most, m.hemispherical(i));
  if (most > most_scattered)
    fail(block, fmt::format("'{}' scatters {:.3g} times the light that arrives",
                            text_of(block, "WavelengthDataDirection"), most));
}

// Warns of matrices that differ from those of the reverse ways.
void report_reciprocity(const AngularBsdf& b, WarningLog& warnings) {
  constexpr double notable = 0.25;  // of the greatest value; noise of genBSDF is below it
  const auto check = [&](const AngleMatrix& m, const AngleMatrix& reverse, const char* what) {
    if (m.is_empty() || reverse.is_empty()) return;
    const double error = reciprocity_error(m, reverse);
    if (error > notable)
      warnings.add(
          fmt::format("a BSDF file is not reciprocal: {} differs from its reverse by {:.0f} "
                      "% of the greatest value",
                      what, 100 * error));
  };
  check(b.to_front, b.to_back, "transmission");
  check(b.front_reflection, b.front_reflection, "reflection at the back");
  check(b.back_reflection, b.back_reflection, "reflection at the front");
}

bool is_dark(const AngleMatrix& m) {
  return std::all_of(m.values.begin(), m.values.end(), [](float v) { return v == 0; });
}

AngularBsdf WindowXml::read() {
  pugi::xml_document document;
  const auto parsed = document.load_buffer(text_.data(), text_.size());
  if (!parsed) {
    const TextPosition at =
        position_of_offset(text_, size_t(std::max<ptrdiff_t>(parsed.offset, 0)));
    throw InputError(file_, at.line, at.column,
                     std::string("not valid XML: ") + parsed.description());
  }
  const pugi::xml_node root = document.child("WindowElement");
  const pugi::xml_node layer = root.child("Optical").child("Layer");
  if (!layer)
    throw InputError(file_, 1, 1, "is not a BSDF file: it has no WindowElement with a Layer");
  if (layer.next_sibling("Layer"))
    warnings_.add("a BSDF file has several layers: the first is read");
  read_structure(layer.child("DataDefinition"));
  AngularBsdf out;
  out.name = trimmed(layer.child("Material").child("Name").text().get());
  const std::map<std::string, AngleMatrix*> ways{{"transmission front", &out.to_front},
                                                 {"transmission back", &out.to_back},
                                                 {"reflection front", &out.back_reflection},
                                                 {"reflection back", &out.front_reflection}};
  for (const pugi::xml_node& data : layer.children("WavelengthData")) {
    const std::string wavelength = lower_case(trimmed(data.child("Wavelength").text().get()));
    if (wavelength.starts_with("cie-"))
      warnings_.add("a BSDF file has colours (CIE-X, CIE-Z): it is read in grey, by its luminance");
    if (wavelength != "visible") continue;
    for (const pugi::xml_node& block : data.children("WavelengthDataBlock")) {
      const auto way = ways.find(lower_case(text_of(block, "WavelengthDataDirection")));
      if (way == ways.end()) continue;  // absorptance and the like
      *way->second = read_block(block);
      check_energy(block, *way->second);
    }
  }
  if (is_dark(out.to_back)) out.to_back = reversed(out.to_front);
  if (is_dark(out.to_front)) out.to_front = reversed(out.to_back);
  if (out.to_front.is_empty() && out.front_reflection.is_empty() && out.back_reflection.is_empty())
    throw InputError(file_, 1, 1, "has no visible BSDF data");
  report_reciprocity(out, warnings_);
  return out;
}

}  // namespace

AngularBsdf read_window_xml(const std::string& file, const std::string& text,
                            WarningLog& warnings) {
  return WindowXml(file, text, warnings).read();
}

}  // namespace troffer
