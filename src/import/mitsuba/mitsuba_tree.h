// The elements of Mitsuba's XML files: read, with includes, defaults and references put in, and
// names brought to one spelling.
//
// References: [1] W. Jakob et al., "Mitsuba 3 documentation: Scene XML file format";
//   [2] W. Jakob, "Mitsuba 0.6 Documentation", §6 (Scene file format).
#pragma once

#include <deque>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/log.h"
#include "import/file.h"
#include "import/source_place.h"

namespace troffer {

// One element. Attribute values have their $parameters put in.
struct MitsubaNode {
  std::string tag;
  std::string type;  // of plugins: "diffuse"
  std::string name;  // snake_case, as from version 2 on: toWorld -> to_world
  std::string id;
  std::map<std::string, std::string> attributes;  // all others, value among them
  std::vector<const MitsubaNode*> children;
  SourcePlace place;
  mutable bool is_used = false;

  bool has(const std::string& attribute) const { return attributes.contains(attribute); }
  // "" where there is none.
  const std::string& attribute(const std::string& key) const;
};

class MitsubaTree {
 public:
  // The file with all it includes, looked up in its folder and never outside. InputError: what is
  // no XML, nests too deeply or is too large; files that cannot be read.
  MitsubaTree(const std::string& path, WarningLog& warnings);

  const MitsubaNode& root() const { return nodes_.front(); }
  const std::deque<MitsubaNode>& all() const { return nodes_; }
  // Folder that files are looked up in.
  const std::string& folder() const { return folder_; }
  // Where a file is that the scene names: in its folder, else in those of <path> within that, by
  // their order. A file that is nowhere counts as in the scene's folder.
  ConfinedPath file(const std::string& name) const;
  // Whether the file speaks Mitsuba 0.2 to 0.6, whose defaults differ here and there.
  bool is_legacy() const { return is_legacy_; }
  // The element that `node` refers to where it is a ref (InputError: an unknown id), else itself.
  const MitsubaNode& resolved(const MitsubaNode& node) const;

 private:
  friend class MitsubaTreeReader;
  std::string folder_;
  std::vector<std::string> paths_;  // of <path>, from the folder
  bool is_legacy_ = false;
  std::deque<MitsubaNode> nodes_;
  std::map<std::string, const MitsubaNode*> by_id_;
};

// "toWorld" -> "to_world", "intIOR" -> "int_ior".
std::string snake_case(std::string_view name);

}  // namespace troffer
