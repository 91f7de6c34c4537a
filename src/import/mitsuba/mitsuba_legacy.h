// Renames elements of Mitsuba files before 0.4 to their later names. Used while MitsubaTree reads,
// so that all other readers know only the newest names.
//
// References: [1] W. Jakob, "Mitsuba 0.6 Documentation", §6 (Scene file format); [2] Mitsuba 0.6,
//   data/schema/upgrade_0.3.0.xsl and upgrade_0.4.0.xsl, which list the renamed elements.
#pragma once

#include <deque>
#include <string_view>

#include "import/mitsuba/mitsuba_tree.h"

namespace troffer {

// Major and minor number of a version: "0.3.0" -> {0, 3}. Other text counts as the newest version.
struct MitsubaVersion {
  int major = 3, minor = 0;
  bool is_below(int a, int b) const { return major < a || (major == a && minor < b); }
};
MitsubaVersion mitsuba_version(std::string_view text);

// Updates elements of older versions to the newest names while they are read.
class MitsubaUpgrade {
 public:
  // New elements are appended to `nodes`, which must outlive this object.
  explicit MitsubaUpgrade(std::deque<MitsubaNode>& nodes) : nodes_(nodes) {}
  void set_version(const MitsubaVersion& version) { version_ = version; }

  // Updates an element that has its attributes but no children yet. `parent` will be its parent.
  void begin(MitsubaNode& node, MitsubaNode& parent);
  // Updates an element that has all its children.
  void end(MitsubaNode& node);

 private:
  std::deque<MitsubaNode>& nodes_;
  MitsubaVersion version_;

  void begin_before_0_3(MitsubaNode& node, MitsubaNode& parent);
  void begin_before_0_4(MitsubaNode& node, MitsubaNode& parent);
  void scale_reflectance(MitsubaNode& node, const char* kind, double fallback);
  void add(MitsubaNode& to, const char* tag, const char* key, const std::string& value);
};

}  // namespace troffer
