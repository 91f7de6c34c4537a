// The folder into which `report` and `annual` write their files.
#pragma once

#include <string>

namespace troffer {

// The folder is created if missing, and removed again if nothing is written. Throws
// EnvironmentError if it cannot be made.
class ReportFolder {
 public:
  explicit ReportFolder(std::string path);
  ~ReportFolder();
  ReportFolder(const ReportFolder&) = delete;
  ReportFolder& operator=(const ReportFolder&) = delete;
  // Returns the path of a file in the folder.
  std::string file(const std::string& name) const;

 private:
  std::string path_;
  bool is_new_ = false;
};

}  // namespace troffer
