#include "import/mesh/ply_attributes.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string_view>

#include "base/error.h"
#include "base/rgb.h"
#include "import/file.h"
#include "import/mesh/ply_body.h"

namespace troffer {

namespace {

constexpr size_t most_channels = 4;

// Suffixes that name the channels of one attribute, in order.
// Numbers count from 0 or from 1.
constexpr std::array<std::string_view, 3> attribute_endings{"xyzw", "rgba", "01234"};

// Attribute and channel of a property.
struct AttributeColumn {
  std::string attribute;
  size_t channel = 0;
  bool is_numbered = false;
};

// Returns an empty name if the property belongs to no attribute.
AttributeColumn column_of(const std::string& name) {
  constexpr std::array<std::string_view, 4> long_names{"red", "green", "blue", "alpha"};
  for (size_t k = 0; k < 4; ++k)
    if (name == long_names[k] || name == std::string(1, attribute_endings[1][k]))
      return {"color", k};
  const size_t at = name.rfind('_');
  if (at == std::string::npos || at == 0 || at + 2 != name.size()) return {};
  for (const std::string_view ending : attribute_endings) {
    const size_t k = ending.find(name[at + 1]);
    if (k == std::string_view::npos) continue;
    // Mitsuba appends "_color" to the name of {prefix}_{r|g|b|a}.
    return {name.substr(0, at) + (ending == attribute_endings[1] ? "_color" : ""), k,
            ending == attribute_endings[2]};
  }
  return {};
}

float decoded(double value, PlyType type) {
  if (!is_integer(type)) return float(value);
  const bool is_signed = type == PlyType::int8 || type == PlyType::int16 || type == PlyType::int32;
  const double largest = double((uint64_t(1) << (8 * size_of(type) - (is_signed ? 1 : 0))) - 1);
  return linear_from_srgb(float(std::clamp(value / largest, 0.0, 1.0)));
}

class AttributeReader {
 public:
  AttributeReader(const PlyElement& element, bool is_of_faces)
      : element_(element), is_of_faces_(is_of_faces) {
    for (const PlyProperty& p : element.properties) {
      const AttributeColumn c = p.is_list ? AttributeColumn{} : column_of(p.name);
      columns_.push_back(c);
      if (c.is_numbered && c.channel == 0) counts_from_0_.insert(c.attribute);
    }
    for (AttributeColumn& c : columns_) {
      if (c.attribute.empty()) continue;
      if (c.is_numbered && counts_from_0_.count(c.attribute) == 0) --c.channel;
      if (c.channel >= most_channels) c = {};  // a fifth number
      if (c.attribute.empty()) continue;
      size_t& channels = channels_[c.attribute];
      channels = std::max(channels, c.channel + 1);
    }
    for (const auto& [name, channels] : channels_) rows_[name].resize(channels);
  }

  void read(PlyBody& body) {
    for (uint64_t i = 0; i < element_.count; ++i) read_row(body);
  }

  void move_to(std::vector<PlyAttribute>& out) {
    for (auto& [name, channels] : channels_) {
      PlyAttribute& a = values_[name];
      a.name = (is_of_faces_ ? "face_" : "vertex_") + name;
      a.is_of_faces = is_of_faces_;
      a.channels = channels;
      out.push_back(std::move(a));
    }
  }

 private:
  const PlyElement& element_;
  bool is_of_faces_;
  std::set<std::string> counts_from_0_;  // names of attributes
  std::vector<AttributeColumn> columns_;
  std::map<std::string, size_t> channels_;
  std::map<std::string, std::vector<float>> rows_;  // values of the current row
  std::map<std::string, PlyAttribute> values_;

  void read_row(PlyBody& body) {
    size_t copies = is_of_faces_ ? 0 : 1;
    for (size_t k = 0; k < columns_.size(); ++k) {
      const PlyProperty& p = element_.properties[k];
      if (p.is_list) {
        const size_t n = body.list_length(p);
        for (size_t i = 0; i < n; ++i) body.next(p.type);
        if (is_of_faces_ && n >= 3 && (p.name == "vertex_indices" || p.name == "vertex_index"))
          copies = n - 2;
        continue;
      }
      const double value = body.next(p.type);
      if (!columns_[k].attribute.empty())
        rows_[columns_[k].attribute][columns_[k].channel] = decoded(value, p.type);
    }
    for (const auto& [name, row] : rows_)
      for (size_t i = 0; i < copies; ++i)
        values_[name].values.insert(values_[name].values.end(), row.begin(), row.end());
  }
};

}  // namespace

std::vector<PlyAttribute> read_ply_attributes(const std::string& path) {
  const std::string text = read_text_file(path);
  const PlyHeader header = parse_ply_header(text, path);
  PlyBody body(text, header.body, header.body_line, header.format, path);
  std::vector<PlyAttribute> out;
  for (const PlyElement& element : header.elements) {
    const bool is_known = element.name == "vertex" || element.name == "face";
    AttributeReader reader(element, element.name == "face");
    reader.read(body);
    if (is_known) reader.move_to(out);
  }
  return out;
}

}  // namespace troffer
