#include "import/mitsuba/mitsuba_tree.h"

#include <algorithm>
#include <filesystem>
#include <pugixml.hpp>
#include <system_error>

#include "import/file.h"
#include "import/mitsuba/mitsuba_legacy.h"

namespace troffer {

namespace {

constexpr uint64_t max_mitsuba_bytes = uint64_t(256) << 20;  // limit for all files together
constexpr size_t max_nodes = 8'000'000;
constexpr size_t max_element_depth = 64, max_included_files = 200, max_nested_files = 16;
constexpr size_t max_expanded_bytes = size_t(64) << 20;  // limit for all values with $parameters
constexpr size_t max_value = size_t(1) << 20;

bool is_upper(char c) {
  return c >= 'A' && c <= 'Z';
}
bool is_name_character(char c) {
  return is_upper(c) || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
}

// Line starts of a file; finds the line and column of an offset.
class Lines {
 public:
  explicit Lines(std::string_view text) {
    for (size_t i = 0; i < text.size(); ++i)
      if (text[i] == '\n') begins_.push_back(i + 1);
  }
  SourcePlace place(const std::shared_ptr<const std::string>& file, ptrdiff_t offset) const {
    const size_t at = offset > 0 ? size_t(offset) : 0;
    const auto next = std::upper_bound(begins_.begin(), begins_.end(), at);
    return {file, int(next - begins_.begin()), int(at - *(next - 1)) + 1};
  }

 private:
  std::vector<size_t> begins_{0};
};

}  // namespace

std::string snake_case(std::string_view name) {
  std::string out;
  for (size_t i = 0; i < name.size(); ++i) {
    if (is_upper(name[i]) && i > 0 && !is_upper(name[i - 1]) && name[i - 1] != '_') out += '_';
    out += is_upper(name[i]) ? char(name[i] - 'A' + 'a') : name[i];
  }
  return out;
}

const std::string& MitsubaNode::attribute(const std::string& key) const {
  static const std::string nothing;
  const auto found = attributes.find(key);
  return found == attributes.end() ? nothing : found->second;
}

class MitsubaTreeReader {
 public:
  MitsubaTreeReader(MitsubaTree& tree, WarningLog& warnings)
      : tree_(tree), warnings_(warnings), upgrade_(tree.nodes_) {}

  void read_root(const std::string& path);

 private:
  // A file whose elements are being copied.
  struct Open {
    std::shared_ptr<const std::string> path;
    const Lines& lines;
  };

  MitsubaTree& tree_;
  WarningLog& warnings_;
  MitsubaUpgrade upgrade_;
  std::map<std::string, std::string> parameters_;
  uint64_t bytes_ = 0;
  size_t files_ = 0, open_files_ = 0, expanded_bytes_ = 0;
  // First parameter without <default> in the element that is being read; "" if there is none.
  std::string unknown_;

  void read_file_into(const std::string& path, const SourcePlace* from, MitsubaNode& parent,
                      size_t depth);
  void set_version(const pugi::xml_node& root);
  void add_children(const Open& open, const pugi::xml_node& from, MitsubaNode& to, size_t depth);
  void add_child(const Open& open, const pugi::xml_node& from, MitsubaNode& to, size_t depth);
  void add_path(const MitsubaNode& node);
  void include(const MitsubaNode& node, MitsubaNode& parent, size_t depth);
  void fill(const pugi::xml_node& from, MitsubaNode& node);
  std::string expanded(std::string_view text, const SourcePlace& place);
  void leave_out(const MitsubaNode& node, const MitsubaNode& parent);
};

void MitsubaTreeReader::read_root(const std::string& path) {
  tree_.nodes_.emplace_back();
  read_file_into(path, nullptr, tree_.nodes_.front(), 0);
}

void MitsubaTreeReader::read_file_into(const std::string& path, const SourcePlace* from,
                                       MitsubaNode& parent, size_t depth) {
  const auto name = std::make_shared<const std::string>(path);
  const SourcePlace top{name, 0, 0};
  if (++files_ > max_included_files || open_files_ >= max_nested_files)
    (from ? *from : top).fail("includes too many files, or itself");
  const std::string text = read_text_file(path, max_mitsuba_bytes);
  bytes_ += text.size();
  if (bytes_ > max_mitsuba_bytes) top.fail("the files of this scene are too large");
  const Lines lines(text);
  pugi::xml_document document;
  // Entities of a document type are never expanded.
  const pugi::xml_parse_result result = document.load_buffer(text.data(), text.size());
  if (!result) lines.place(name, result.offset).fail(std::string("XML: ") + result.description());
  const pugi::xml_node root = document.document_element();
  if (!root) top.fail("has no XML element");
  const std::string tag = root.name();
  const Open open{name, lines};
  ++open_files_;
  if (tag == "scene") {
    if (!from) {
      parent.tag = tag;
      parent.place = lines.place(name, root.offset_debug());
      set_version(root);
    }
    add_children(open, root, parent, depth);
  } else if (from) {
    add_child(open, root, parent, depth);
  } else {
    lines.place(name, root.offset_debug())
        .fail("is not a Mitsuba scene: its first element is <" + shortened(tag) + ">, not <scene>");
  }
  --open_files_;
}

// A file without a version counts as 0.2 if it has elements that only such files have.
void MitsubaTreeReader::set_version(const pugi::xml_node& root) {
  const bool is_first = root.child("camera") || root.child("luminaire");
  const MitsubaVersion version =
      mitsuba_version(root.attribute("version").as_string(is_first ? "0.2" : "3.0"));
  tree_.is_legacy_ = version.major == 0;
  upgrade_.set_version(version);
}

void MitsubaTreeReader::add_children(const Open& open, const pugi::xml_node& from, MitsubaNode& to,
                                     size_t depth) {
  for (const pugi::xml_node& child : from.children())
    if (child.type() == pugi::node_element) add_child(open, child, to, depth);
}

void MitsubaTreeReader::fill(const pugi::xml_node& from, MitsubaNode& node) {
  for (const pugi::xml_attribute& a : from.attributes()) {
    const std::string key = a.name();
    std::string value = expanded(a.value(), node.place);
    if (key == "type")
      node.type = std::move(value);
    else if (key == "name")
      node.name = node.tag == "default" ? std::move(value) : snake_case(value);
    else if (key == "id")
      node.id = std::move(value);
    else
      node.attributes[key] = std::move(value);
  }
}

// Mitsuba takes such parameters from its command line. Integrators and samplers have no effect
// here, so these are left out without a warning.
void MitsubaTreeReader::leave_out(const MitsubaNode& node, const MitsubaNode& parent) {
  if (node.tag == "include" || node.tag == "default")
    node.place.fail("the parameter $" + unknown_ + " has no <default>");
  const auto is_made_so = [](const std::string& tag) {
    return tag == "integrator" || tag == "sampler";
  };
  if (!is_made_so(node.tag) && !is_made_so(parent.tag))
    warnings_.add("the parameter $" + unknown_ + " has no <default>: <" + shortened(node.tag) +
                  (node.name.empty() ? "" : " " + shortened(node.name)) + "> is left out");
}

void MitsubaTreeReader::add_child(const Open& open, const pugi::xml_node& from, MitsubaNode& to,
                                  size_t depth) {
  const SourcePlace place = open.lines.place(open.path, from.offset_debug());
  if (depth >= max_element_depth) place.fail("elements nest too deeply");
  if (tree_.nodes_.size() >= max_nodes) place.fail("the scene has too many elements");
  MitsubaNode& node = tree_.nodes_.emplace_back();
  node.tag = from.name();
  node.place = place;
  unknown_.clear();
  fill(from, node);
  if (!unknown_.empty()) return leave_out(node, to);
  upgrade_.begin(node, to);
  if (node.tag == "default") {
    parameters_.emplace(node.name, node.attribute("value"));  // keeps the first definition
  } else if (node.tag == "include") {
    include(node, to, depth);
  } else if (node.tag == "alias") {
    const auto found = tree_.by_id_.find(node.id);
    if (found == tree_.by_id_.end())
      place.fail("alias of the unknown id '" + shortened(node.id) + "'");
    tree_.by_id_[node.attribute("as")] = found->second;
  } else if (node.tag == "path") {
    add_path(node);
  } else {
    if (!node.id.empty() && node.tag != "ref" && !tree_.by_id_.emplace(node.id, &node).second) {
      warnings_.add("id '" + shortened(node.id) + "' is defined again: the later one is used");
      tree_.by_id_[node.id] = &node;
    }
    to.children.push_back(&node);
    add_children(open, from, node, depth + 1);
    upgrade_.end(node);
  }
}

void MitsubaTreeReader::add_path(const MitsubaNode& node) {
  const std::string& name = node.attribute("value");
  const ConfinedPath path = confined_path(tree_.folder(), name + "/x");
  if (path.is_fine())
    tree_.paths_.push_back(name);
  else
    warnings_.add("<path> '" + shortened(name) + "' is not used: " + path.problem);
}

void MitsubaTreeReader::include(const MitsubaNode& node, MitsubaNode& parent, size_t depth) {
  const std::string& name = node.attribute("filename");
  const ConfinedPath path = tree_.file(name);
  if (!path.is_fine()) node.place.fail("cannot use '" + shortened(name) + "': " + path.problem);
  read_file_into(path.path, &node.place, parent, depth);
}

// Replaces $name and (versions 0.x to 3) ${name} by the parameter's value.
std::string MitsubaTreeReader::expanded(std::string_view text, const SourcePlace& place) {
  if (text.find('$') == std::string_view::npos) return std::string(text);
  std::string out;
  for (size_t i = 0; i < text.size();) {
    if (text[i] != '$') {
      out += text[i++];
      continue;
    }
    const bool has_braces = i + 1 < text.size() && text[i + 1] == '{';
    const size_t begin = i + (has_braces ? 2 : 1);
    size_t end = begin;
    while (end < text.size() && is_name_character(text[end])) ++end;
    const std::string name(text.substr(begin, end - begin));
    const auto found = parameters_.find(name);
    if (found == parameters_.end()) {
      if (unknown_.empty()) unknown_ = shortened(name);
      return "";
    }
    out += found->second;
    expanded_bytes_ += found->second.size() + 1;
    if (out.size() > max_value || expanded_bytes_ > max_expanded_bytes)
      place.fail("parameters expand to too much text");
    i = has_braces && end < text.size() && text[end] == '}' ? end + 1 : end;
  }
  return out;
}

MitsubaTree::MitsubaTree(const std::string& path, WarningLog& warnings) : folder_(folder_of(path)) {
  MitsubaTreeReader(*this, warnings).read_root(path);
}

ConfinedPath MitsubaTree::file(const std::string& name) const {
  ConfinedPath beside = confined_path(folder_, name);
  const auto exists = [](const ConfinedPath& path) {
    std::error_code error;
    return path.is_fine() && std::filesystem::exists(path.path, error);
  };
  if (paths_.empty() || exists(beside)) return beside;
  for (const std::string& folder : paths_)
    if (ConfinedPath path = confined_path(folder_, folder + "/" + name); exists(path)) return path;
  return beside;
}

const MitsubaNode& MitsubaTree::resolved(const MitsubaNode& node) const {
  if (node.tag != "ref") return node;
  const auto found = by_id_.find(node.id);
  if (found == by_id_.end()) node.place.fail("no element has the id '" + shortened(node.id) + "'");
  node.is_used = true;
  return *found->second;
}

}  // namespace troffer
