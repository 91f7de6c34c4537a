// Outputs that are not regular files, and files that cannot grow: no call hangs, no file is
// replaced by mistake, and no temporary file remains.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <functional>
#include <thread>

#include "base/error.h"
#include "image/atomic_file.h"
#include "image/fixtures.h"
#include "image/read_image.h"

using namespace troffer;

namespace test_outputs {
using test::TemporaryFolder;

namespace {

std::string text_of(const std::string& path) {
  const auto bytes = read_file_bytes(path);
  return {bytes.begin(), bytes.end()};
}

std::string why_not(const std::function<void()>& write) {
  try {
    write();
  } catch (const EnvironmentError& e) {
    return e.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string read_to_end(int descriptor) {
  std::string all;
  char buffer[4096];
  for (ssize_t n = 0; (n = read(descriptor, buffer, sizeof(buffer))) > 0;)
    all.append(buffer, size_t(n));
  return all;
}

// Runs body() in a forked process. Returns its exit status, or 128 + signal if a signal ended it.
int status_of(const std::function<void()>& body) {
  const pid_t pid = fork();
  if (pid == 0) {
    for (const int s : {SIGXFSZ, SIGPIPE}) signal(s, SIG_DFL);
    body();
    _exit(0);
  }
  int status = 0;
  waitpid(pid, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

TEST_CASE("a pipe without a reader is an error, not an endless wait") {
  const TemporaryFolder folder;
  const std::string pipe = folder.path("pipe.csv");
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  CHECK(contains(why_not([&] { OutputReservation reserved(pipe); }), "nobody reads"));
  CHECK(folder.entries() == 1);
}

TEST_CASE("a reader of a pipe gets all that is written after the reservation") {
  const TemporaryFolder folder;
  const std::string pipe = folder.path("pipe.csv");
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  const std::string large(300000, 'x');  // exceeds a pipe's capacity
  std::string got;
  std::thread reader([&] {
    const int descriptor = open(pipe.c_str(), O_RDONLY);
    got = read_to_end(descriptor);
    close(descriptor);
  });
  {
    const OutputReservation reserved(pipe);
    CHECK(why_not([&] { write_file(pipe, large); }).empty());
    CHECK(why_not([&] { write_file(pipe, "end"); }).empty());
  }
  reader.join();
  CHECK(got == large + "end");
}

TEST_CASE("a reader that disconnects is an error and does not end the process") {
  const TemporaryFolder folder;
  const std::string pipe = folder.path("pipe.csv");
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  CHECK(status_of([&] {
          const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
          AtomicFile file(pipe);
          close(reader);
          if (contains(why_not([&] { file.write("x"); }), "Broken pipe")) _exit(7);
        }) == 7);
}

TEST_CASE("an open file is written at its position and stays the same file") {
  const TemporaryFolder folder;
  const std::string path = folder.path("redirected");
  const int descriptor = open(path.c_str(), O_RDWR | O_CREAT, 0600);
  REQUIRE(descriptor >= 0);
  struct stat before {};
  REQUIRE(fstat(descriptor, &before) == 0);
  REQUIRE(write(descriptor, "head ", 5) == 5);
  const std::string number = std::to_string(descriptor);
  write_file("/dev/fd/" + number, "one ");
  write_file("/proc/self/fd/" + number, "two ");
  std::filesystem::create_symlink("/dev/fd/" + number, folder.path("link"));
  std::filesystem::create_symlink("link", folder.path("link.csv"));
  write_file(folder.path("link.csv"), "three ");
  REQUIRE(write(descriptor, "tail", 4) == 4);
  CHECK(text_of(path) == "head one two three tail");
  struct stat after {};
  REQUIRE(stat(path.c_str(), &after) == 0);
  CHECK(after.st_ino == before.st_ino);
  close(descriptor);
  CHECK(contains(why_not([&] { OutputReservation reserved("/dev/fd/" + number); }),
                 "Bad file descriptor"));
  const int input = open(path.c_str(), O_RDONLY);
  CHECK(contains(why_not([&] { OutputReservation r("/dev/fd/" + std::to_string(input)); }),
                 "reading only"));
  close(input);
}

TEST_CASE("disks and sockets are refused") {
  const TemporaryFolder folder;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = folder.path("s");
  REQUIRE(path.size() < sizeof(address.sun_path));
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  const int s = socket(AF_UNIX, SOCK_STREAM, 0);
  REQUIRE(bind(s, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0);
  CHECK(contains(why_not([&] { OutputReservation reserved(path); }), "it is a socket"));
  close(s);
  const std::string disk = folder.path("disk");  // only a node: there is no such disk
  if (mknod(disk.c_str(), S_IFBLK | 0600, makedev(250, 250)) == 0)
    CHECK(contains(why_not([&] { OutputReservation reserved(disk); }), "it is a disk"));
}

TEST_CASE("exceeding a file size limit is an error and leaves nothing behind") {
  const TemporaryFolder folder;
  CHECK(status_of([&] {
          const rlimit limit{1000, 1000};
          setrlimit(RLIMIT_FSIZE, &limit);
          const std::string reason =
              why_not([&] { write_file(folder.path("a.csv"), std::string(4000, 'x')); });
          if (contains(reason, "File too large")) _exit(7);
        }) == 7);
  CHECK(folder.entries() == 0);
}

TEST_CASE("a process that a signal ends takes its half-written files with it") {
  const TemporaryFolder folder;
  write_file(folder.path("mine.csv"), "mine");
  CHECK(status_of([&] {
          AtomicFile one(folder.path("one.csv")), two(folder.path("mine.csv"));
          AtomicFile done(folder.path("done.csv"));
          one.write("half");
          done.commit();
          if (folder.entries() != 4) _exit(1);
          remove_temporary_files();
          // A file that another thread begins afterwards must not remain either.
          if (!contains(why_not([&] { AtomicFile late(folder.path("late")); }), "ending")) _exit(2);
          _exit(7);  // without destructors, as in a signal handler
        }) == 7);
  CHECK(folder.entries() == 2);
  CHECK(text_of(folder.path("mine.csv")) == "mine");
}

}  // namespace test_outputs
