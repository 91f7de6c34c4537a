#include "export/output_folder.h"

#include <filesystem>
#include <system_error>

#include "base/error.h"
#include "image/atomic_file.h"

namespace troffer {

namespace fs = std::filesystem;

namespace {

// Quotes and line ends would not survive in the scene's file.
std::string plain(std::string name) {
  for (char& c : name)
    if (static_cast<unsigned char>(c) < 32 || c == '"' || c == '\\') c = '_';
  return name;
}

}  // namespace

OutputFolder::OutputFolder(const std::string& path)
    : folder_(plain(fs::path(path).stem().string()) + "_files"),
      path_((fs::path(path).parent_path() / folder_).string()) {}

void OutputFolder::write(const std::string& name, std::span<const uint8_t> bytes) {
  if (!is_made_) {
    std::error_code error;
    fs::create_directories(path_, error);
    if (error) throw EnvironmentError("cannot make the folder " + path_ + ": " + error.message());
    is_made_ = true;
  }
  AtomicFile file((fs::path(path_) / name).string());
  file.write(bytes);
  file.commit();
}

std::string OutputFolder::relative(const std::string& name) const {
  return folder_ + "/" + name;
}

std::string printable_comment(std::string_view name) {
  return plain(std::string(name.substr(0, 200)));
}

}  // namespace troffer
