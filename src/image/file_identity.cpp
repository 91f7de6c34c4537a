#include "image/file_identity.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>

#include "image/output_target.h"
#include "image/temporary_files.h"

namespace troffer {

namespace {

FileIdentity identity_of(const struct stat& info) {
  return {uint64_t(info.st_dev), uint64_t(info.st_ino), ""};
}

// Converts A to Z to lower case: only these letters are equal on every case-insensitive file
// system.
std::string in_small_letters(std::string name) {
  for (char& c : name)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return name;
}

// True if names that differ only in case are the same file in the folder. Creates a file and looks
// for its name in capitals.
bool ignores_case(const std::string& folder) {
  const std::string own = ".troffer-" + std::to_string(getpid()) + "-case.tmp";
  std::string other = own;
  std::transform(other.begin(), other.end(), other.begin(),
                 [](char c) { return c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c; });
  const TemporaryFile cleaner(folder + own);
  const int file = open((folder + own).c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (file < 0) return false;
  close(file);
  struct stat info {};
  const bool is_same = stat((folder + other).c_str(), &info) == 0;
  unlink((folder + own).c_str());
  return is_same;
}

}  // namespace

std::optional<FileIdentity> identity_of_input(const std::string& path) {
  struct stat info {};
  if (path.empty() || stat(path.c_str(), &info) != 0 || S_ISCHR(info.st_mode)) return std::nullopt;
  return identity_of(info);
}

std::optional<FileIdentity> identity_of_descriptor(int descriptor) {
  struct stat info {};
  if (fstat(descriptor, &info) != 0 || !S_ISREG(info.st_mode)) return std::nullopt;
  return identity_of(info);
}

std::optional<FileIdentity> identity_of_output(const std::string& path) {
  const OutputTarget target = output_target(path);
  struct stat info {};
  if (target.kind == OutputTarget::Kind::descriptor) {
    if (fstat(target.descriptor, &info) != 0 || S_ISCHR(info.st_mode)) return std::nullopt;
    return identity_of(info);
  }
  if (stat(target.path.c_str(), &info) == 0)
    return S_ISCHR(info.st_mode) ? std::nullopt : std::optional(identity_of(info));
  const size_t slash = target.path.rfind('/');
  const std::string folder = slash == std::string::npos ? "./" : target.path.substr(0, slash + 1);
  if (stat(folder.c_str(), &info) != 0) return std::nullopt;
  FileIdentity identity = identity_of(info);
  identity.name = target.path.substr(slash == std::string::npos ? 0 : slash + 1);
  const std::string small = in_small_letters(identity.name);
  if (small != identity.name && ignores_case(folder)) identity.name = small;
  return identity;
}

}  // namespace troffer
