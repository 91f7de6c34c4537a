#include "image/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <utility>

namespace troffer {

namespace {

std::string folder_of(const std::string& path) {
  const size_t slash = path.rfind('/');
  return slash == path.npos ? std::string("./") : path.substr(0, slash + 1);
}

}  // namespace

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)), target_(output_target(path_)) {
  if (target_.kind != OutputTarget::Kind::file) {
    descriptor_ = open_stream(target_, path_);
    return;
  }
  open_temporary();
  // A file that was private stays private. Where this is not allowed the default will do.
  struct stat info {};
  if (stat(target_.path.c_str(), &info) == 0 && fchmod(descriptor_, info.st_mode & 0777) != 0)
    errno = 0;
}

// A hidden file in the target's folder; its name does not grow with the target's.
void AtomicFile::open_temporary() {
  for (int attempt = 0; attempt < 1000; ++attempt) {
    temporary_ = folder_of(target_.path) + ".troffer-" + std::to_string(getpid()) + "-" +
                 std::to_string(attempt) + ".tmp";
    cleaner_ = TemporaryFile(temporary_);
    descriptor_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ >= 0) break;
    if (errno != EEXIST) break;
  }
  if (descriptor_ < 0) {
    const int error = errno;
    temporary_.clear();
    fail_to_write(path_, error);
  }
  if (are_temporary_files_removed()) {
    discard();
    fail_to_write(path_, "the program is ending");
  }
}

AtomicFile::~AtomicFile() {
  discard();
}

void AtomicFile::discard() noexcept {
  if (descriptor_ >= 0) close(descriptor_);
  descriptor_ = -1;
  if (!temporary_.empty()) unlink(temporary_.c_str());
  temporary_.clear();
  cleaner_.forget();
}

void AtomicFile::write(std::span<const uint8_t> bytes) {
  write_all(descriptor_, bytes.data(), bytes.size(), path_);
}

void AtomicFile::write(std::string_view text) {
  write_all(descriptor_, text.data(), text.size(), path_);
}

void AtomicFile::commit_to_disk() {
  if (!temporary_.empty() && fsync(descriptor_) != 0) fail_to_write(path_, errno);
  const bool is_file = !temporary_.empty();
  commit();
  if (!is_file) return;
  // The new name is in the folder. Not every file system can sync a folder, or needs to.
  const int folder = open(folder_of(target_.path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  fsync(folder);
  close(folder);
}

void AtomicFile::commit() {
  const int result = close(std::exchange(descriptor_, -1));
  if (result != 0) fail_to_write(path_, errno);
  if (temporary_.empty()) return;
  if (std::rename(temporary_.c_str(), target_.path.c_str()) != 0) fail_to_write(path_, errno);
  temporary_.clear();
  cleaner_.forget();
}

void write_file(const std::string& path, std::string_view text) {
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

OutputReservation::OutputReservation(const std::string& path) {
  const OutputTarget target = output_target(path);
  if (target.kind == OutputTarget::Kind::stream)
    descriptor_ = open_stream(target, path);
  else if (target.kind == OutputTarget::Kind::file)
    const AtomicFile file(path);
}

OutputReservation::~OutputReservation() {
  if (descriptor_ >= 0) close(descriptor_);
}

OutputReservation::OutputReservation(OutputReservation&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

}  // namespace troffer
