// Elements of Mitsuba before 0.4 -> the names that later versions have for them.
//
// References: [1] W. Jakob, "Mitsuba 0.6 Documentation", §6 (Scene file format); [2] Mitsuba 0.6,
//   data/schema/upgrade_0.3.0.xsl and upgrade_0.4.0.xsl, which say what was renamed.
#pragma once

#include <deque>
#include <string_view>

#include "import/mitsuba/mitsuba_tree.h"

namespace troffer {

// Major and minor number of a version: "0.3.0" -> {0, 3}. What is no version is as the newest.
struct MitsubaVersion {
  int major = 3, minor = 0;
  bool is_below(int a, int b) const { return major < a || (major == a && minor < b); }
};
MitsubaVersion mitsuba_version(std::string_view text);

// Brings elements of older versions to the newest names, while they are read.
class MitsubaUpgrade {
 public:
  // New elements are put at the end of `nodes`, which must outlive this.
  explicit MitsubaUpgrade(std::deque<MitsubaNode>& nodes) : nodes_(nodes) {}
  void set_version(const MitsubaVersion& version) { version_ = version; }

  // An element that has its attributes, but no children yet, and will be one of `parent`.
  void begin(MitsubaNode& node, MitsubaNode& parent);
  // … that has its children.
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
