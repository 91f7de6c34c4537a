#include "image/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <utility>

namespace troffer {

namespace {

std::string folder_of(const std::string& path) {
  const size_t slash = path.rfind('/');
  return slash == path.npos ? std::string("./") : path.substr(0, slash + 1);
}

// Prefix and suffix of the names of temporary files.
constexpr const char *beginning = ".troffer-", *ending = ".tmp";

}  // namespace

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)), target_(output_target(path_)) {
  if (target_.kind != OutputTarget::Kind::file) {
    descriptor_ = open_stream(target_, path_);
    return;
  }
  open_temporary();
  // Keeps the permissions of the replaced file. If that is not allowed, the default applies.
  struct stat info {};
  if (stat(target_.path.c_str(), &info) == 0 && fchmod(descriptor_, info.st_mode & 0777) != 0)
    errno = 0;
}

// Creates a hidden file in the target's folder. Its name does not depend on the target's, so it
// cannot become too long.
void AtomicFile::open_temporary() {
  for (int attempt = 0; attempt < 1000; ++attempt) {
    temporary_ = folder_of(target_.path) + beginning + std::to_string(getpid()) + "-" +
                 std::to_string(attempt) + ending;
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
  // The lock marks the file as in use. Not every file system supports locks.
  if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) errno = 0;
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

void AtomicFile::finish(bool to_disk) {
  if (is_written_) return;
  is_written_ = true;
  if (to_disk && !temporary_.empty() && fsync(descriptor_) != 0) fail_to_write(path_, errno);
  const int result = close(std::exchange(descriptor_, -1));
  if (result != 0) fail_to_write(path_, errno);
  if (temporary_.empty()) return;
  // Reopened and locked, so that remove_abandoned_files() leaves it alone.
  descriptor_ = open(temporary_.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor_ < 0 || flock(descriptor_, LOCK_EX | LOCK_NB) != 0) errno = 0;
}

void AtomicFile::commit_to_disk() {
  const bool is_file = !temporary_.empty();
  finish(true);
  commit();
  if (!is_file) return;
  // Syncs the folder, which contains the new name. Not every file system can, or needs to.
  const int folder = open(folder_of(target_.path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  fsync(folder);
  close(folder);
}

void AtomicFile::commit() {
  finish();
  if (descriptor_ >= 0) close(std::exchange(descriptor_, -1));
  if (temporary_.empty()) return;
  if (std::rename(temporary_.c_str(), target_.path.c_str()) != 0) fail_to_write(path_, errno);
  temporary_.clear();
  cleaner_.forget();
}

void remove_abandoned_files(const std::string& path) {
  constexpr std::time_t least_age = 60;  // seconds
  std::error_code ignored;
  const std::filesystem::path folder = folder_of(output_target(path).path);
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(beginning) || !name.ends_with(ending)) continue;
    const int file = open(entry.path().c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) continue;
    struct stat info {};
    const bool is_abandoned = fstat(file, &info) == 0 && S_ISREG(info.st_mode) &&
                              info.st_mtime + least_age < std::time(nullptr) &&
                              flock(file, LOCK_EX | LOCK_NB) == 0;
    if (is_abandoned) unlink(entry.path().c_str());
    close(file);
  }
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
