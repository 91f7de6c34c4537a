#include "image/output_target.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <system_error>

#include "base/error.h"

namespace troffer {

namespace {

std::string real_path(const std::string& path) {
  const auto release = [](char* p) { std::free(p); };
  const std::unique_ptr<char, decltype(release)> real(realpath(path.c_str(), nullptr), release);
  return real ? std::string(real.get()) : std::string();
}

// Returns the descriptor that the path names in /proc/self/fd; -1 for other paths.
int descriptor_named(const std::string& path) {
  const size_t slash = path.rfind('/');
  if (slash == path.npos) return -1;
  const std::string name = path.substr(slash + 1);
  const bool is_number =
      !name.empty() && name.size() < 8 &&
      std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  if (!is_number) return -1;
  const std::string folder = real_path(path.substr(0, slash + 1));
  return folder == "/proc/" + std::to_string(getpid()) + "/fd" ? std::stoi(name) : -1;
}

// Returns the target of a link, relative to the current folder.
std::string link_target(const std::string& path) {
  char text[PATH_MAX];
  const ssize_t n = readlink(path.c_str(), text, sizeof(text));
  if (n <= 0) return {};
  const std::string target(text, size_t(n));
  const size_t slash = path.rfind('/');
  return target[0] == '/' || slash == path.npos ? target : path.substr(0, slash + 1) + target;
}

// Returns the open file of this process at the end of a chain of links, or -1. It must not be
// resolved further: if /dev/stdout leads to a file, that open file must not be replaced.
int descriptor_behind(std::string path) {
  constexpr int longest_chain = 40;
  for (int i = 0; i < longest_chain && !path.empty(); ++i) {
    if (const int descriptor = descriptor_named(path); descriptor >= 0) return descriptor;
    path = link_target(path);
  }
  return -1;
}

// Returns the name at the end of a chain of dangling links. The output becomes that file, and the
// links stay.
std::string end_of_links(std::string path, const std::string& named) {
  constexpr int longest_chain = 40;
  for (int i = 0; i < longest_chain; ++i) {
    struct stat info {};
    if (lstat(path.c_str(), &info) != 0 || !S_ISLNK(info.st_mode)) return path;
    path = link_target(path);
    if (path.empty()) fail_to_write(named, "its link cannot be read");
  }
  fail_to_write(named, ELOOP);
}

void wait_a_little() {
  const timespec time{0, 20'000'000};
  nanosleep(&time, nullptr);
}

// Blocks the signals that report a failed write to this thread and discards those that arrive.
// write() then reports the failure by its result.
class QuietWriting {
 public:
  QuietWriting() {
    sigemptyset(&signals_);
    sigaddset(&signals_, SIGPIPE);
    sigaddset(&signals_, SIGXFSZ);
    sigset_t pending;
    sigemptyset(&pending);
    sigpending(&pending);
    for (const int s : {SIGPIPE, SIGXFSZ})
      if (sigismember(&pending, s) == 1) sigdelset(&signals_, s);  // pending before us: leave it
    pthread_sigmask(SIG_BLOCK, &signals_, &before_);
  }
  ~QuietWriting() {
    const int error = errno;
    const timespec at_once{0, 0};
    while (sigtimedwait(&signals_, nullptr, &at_once) > 0) {
    }
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    errno = error;
  }
  QuietWriting(const QuietWriting&) = delete;
  QuietWriting& operator=(const QuietWriting&) = delete;

 private:
  sigset_t signals_, before_;
};

}  // namespace

void fail_to_write(const std::string& path, const std::string& reason) {
  throw EnvironmentError("cannot write " + path + ": " + reason);
}

void fail_to_write(const std::string& path, int error) {
  fail_to_write(path, std::generic_category().message(error));
}

OutputTarget output_target(const std::string& path) {
  using Kind = OutputTarget::Kind;
  if (path.empty()) fail_to_write(path, ENOENT);
  if (const int descriptor = descriptor_behind(path); descriptor >= 0) {
    const int flags = fcntl(descriptor, F_GETFL);
    if (flags < 0) fail_to_write(path, errno);
    if ((flags & O_ACCMODE) == O_RDONLY) fail_to_write(path, "it is open for reading only");
    return {Kind::descriptor, path, descriptor};
  }
  struct stat info {};
  OutputTarget target{Kind::file, path, -1};
  if (lstat(path.c_str(), &info) == 0 && S_ISLNK(info.st_mode)) {
    if (std::string real = real_path(path); !real.empty())
      target.path = std::move(real);
    else if (stat(path.c_str(), &info) != 0)  // else a pipe of another process, in /proc
      target.path = end_of_links(path, path);
  }
  if (target.path.back() == '/') fail_to_write(path, EISDIR);
  if (stat(target.path.c_str(), &info) != 0) return target;
  if (S_ISDIR(info.st_mode)) fail_to_write(path, EISDIR);
  if (S_ISBLK(info.st_mode)) fail_to_write(path, "it is a disk");
  if (S_ISSOCK(info.st_mode)) fail_to_write(path, "it is a socket");
  if (access(target.path.c_str(), W_OK) != 0) fail_to_write(path, errno);
  if (!S_ISREG(info.st_mode)) target.kind = Kind::stream;
  return target;
}

int open_stream(const OutputTarget& target, const std::string& path) {
  if (target.kind == OutputTarget::Kind::descriptor) {
    // Keeps the order with text already printed to it.
    if (target.descriptor == STDOUT_FILENO) std::fflush(stdout);
    const int descriptor = fcntl(target.descriptor, F_DUPFD_CLOEXEC, 0);
    if (descriptor < 0) fail_to_write(path, errno);
    return descriptor;
  }
  constexpr int most_attempts = 250;  // five seconds
  int descriptor = -1;
  for (int i = 0; i < most_attempts; ++i) {
    // Without O_NONBLOCK, opening a pipe waits for a reader, and a serial line for its carrier.
    descriptor = open(target.path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
    if (descriptor >= 0 || (errno != ENXIO && errno != EINTR)) break;
    wait_a_little();
  }
  if (descriptor < 0 && errno == ENXIO) fail_to_write(path, "nobody reads from this pipe");
  if (descriptor < 0) fail_to_write(path, errno);
  fcntl(descriptor, F_SETFL, fcntl(descriptor, F_GETFL) & ~O_NONBLOCK);
  return descriptor;
}

void write_all(int descriptor, const void* bytes, size_t size, const std::string& path) {
  const QuietWriting quiet;
  const char* p = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t n = ::write(descriptor, p, size);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail_to_write(path, errno);
    p += n;
    size -= size_t(n);
  }
}

}  // namespace troffer
