#include "app/report_folder.h"

#include <filesystem>
#include <utility>

#include "base/error.h"

namespace troffer {

ReportFolder::ReportFolder(std::string path) : path_(std::move(path)) {
  std::error_code error;
  is_new_ = !std::filesystem::exists(path_, error);
  std::filesystem::create_directories(path_, error);
  if (error || !std::filesystem::is_directory(path_, error))
    throw EnvironmentError("cannot make the folder " + path_ +
                           (error ? ": " + error.message() : ""));
}

ReportFolder::~ReportFolder() {
  std::error_code ignored;  // fails for a folder with files, which stays
  if (is_new_) std::filesystem::remove(path_, ignored);
}

std::string ReportFolder::file(const std::string& name) const {
  return (std::filesystem::path(path_) / name).string();
}

}  // namespace troffer
