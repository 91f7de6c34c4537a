// Reads Mitsuba's XML files into a tree of elements, with includes, defaults and references
// resolved and names in one spelling. Used by MitsubaReader and all readers of this folder.
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

// One element. Its attribute values have their $parameters replaced.
struct MitsubaNode {
  std::string tag;
  std::string type;  // type of a plugin: "diffuse"
  std::string name;  // in snake_case, as from version 2 on: toWorld -> to_world
  std::string id;
  std::map<std::string, std::string> attributes;  // all other attributes, `value` among them
  std::vector<const MitsubaNode*> children;
  SourcePlace place;
  mutable bool is_used = false;

  bool has(const std::string& attribute) const { return attributes.contains(attribute); }
  // Value of an attribute; "" if it is missing.
  const std::string& attribute(const std::string& key) const;
};

class MitsubaTree {
 public:
  // Reads the file and all that it includes, which is looked up in its folder and never outside.
  // Throws InputError for invalid XML, too deep nesting, too large files and unreadable files.
  MitsubaTree(const std::string& path, WarningLog& warnings);

  const MitsubaNode& root() const { return nodes_.front(); }
  const std::deque<MitsubaNode>& all() const { return nodes_; }
  // Folder that files are looked up in.
  const std::string& folder() const { return folder_; }
  // Path of a file that the scene names: in its folder, otherwise in the folders of <path> within
  // it, in order. A file that does not exist gets its path in the scene's folder.
  ConfinedPath file(const std::string& name) const;
  // True for files of Mitsuba 0.2 to 0.6, some of whose defaults differ.
  bool is_legacy() const { return is_legacy_; }
  // Returns the element that a ref refers to, or `node` itself. Throws InputError for unknown ids.
  const MitsubaNode& resolved(const MitsubaNode& node) const;

 private:
  friend class MitsubaTreeReader;
  std::string folder_;
  std::vector<std::string> paths_;  // paths of <path>, relative to the folder
  bool is_legacy_ = false;
  std::deque<MitsubaNode> nodes_;
  std::map<std::string, const MitsubaNode*> by_id_;
};

// "toWorld" -> "to_world", "intIOR" -> "int_ior".
std::string snake_case(std::string_view name);

}  // namespace troffer
