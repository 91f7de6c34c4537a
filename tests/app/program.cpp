#include "program.h"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <fstream>
#include <iterator>
#include <sstream>
#include <thread>

namespace troffer::test {

const char* const lit_floor_pbrt = R"(LookAt 0 -1.8 1.2  0 0 0.8  0 0 1
Camera "perspective" "float fov" [70]
Film "rgb" "integer xresolution" [40] "integer yresolution" [30]
WorldBegin
Material "diffuse" "rgb reflectance" [0.5 0.5 0.5]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3]
  "point3 P" [-2 -2 0  2 -2 0  2 2 0  -2 2 0]
AttributeBegin
AreaLightSource "diffuse" "rgb L" [5 5 5]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3]
  "point3 P" [-0.5 -0.5 2  -0.5 0.5 2  0.5 0.5 2  0.5 -0.5 2]
AttributeEnd
)";

Folder::Folder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "troffer-test-XXXXXX").string();
  REQUIRE(mkdtemp(pattern.data()) != nullptr);
  path_ = pattern;
}

Folder::~Folder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string Folder::write(const std::string& name, const std::string& text) const {
  std::ofstream(path(name), std::ios::binary) << text;
  return path(name);
}

std::vector<std::string> Folder::names() const {
  std::vector<std::string> all;
  for (const auto& entry : std::filesystem::directory_iterator(path_))
    all.push_back(entry.path().filename().string());
  std::sort(all.begin(), all.end());
  return all;
}

std::string read_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string Finished::remarks() const {
  // A slow machine prints progress lines, such as "render: 44 % after 3 s, 54 MB, 4 s left".
  std::string text;
  std::istringstream in(err);
  for (std::string line; std::getline(in, line);)
    if (line.find(" % after ") == line.npos || line.rfind("warning: ", 0) == 0)
      text += line + (in.eof() ? "" : "\n");
  if (status != 0 || text.empty()) return text;
  const size_t before = text.rfind('\n', text.size() - 2);
  const size_t last = before == text.npos ? 0 : before + 1;
  const bool tells_end =
      text.compare(last, 6, "wrote ") == 0 || text.compare(last, 5, "done ") == 0;
  return tells_end ? text.substr(0, last) : text;
}

std::vector<std::string> Finished::error_lines() const {
  std::vector<std::string> lines;
  std::istringstream in(remarks());
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

Running::Running(const Folder&, const std::vector<std::string>& arguments,
                 const std::function<void()>& prepare) {
  static std::atomic<int> count = 0;
  const std::string base =
      (std::filesystem::temp_directory_path() /
       ("troffer-test-" + std::to_string(getpid()) + "-" + std::to_string(count++)))
          .string();
  out_ = base + ".out";
  err_ = base + ".err";
  std::vector<std::string> words{TROFFER_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& w : words) argv.push_back(w.data());
  argv.push_back(nullptr);
  pid_ = fork();
  REQUIRE(pid_ >= 0);
  if (pid_ > 0) return;
  const int out = open(out_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  const int err = open(err_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  dup2(out, STDOUT_FILENO);
  dup2(err, STDERR_FILENO);
  // doctest installs handlers of its own, and background jobs of a shell ignore SIGINT.
  signal(SIGINT, SIG_DFL);
  signal(SIGTERM, SIG_DFL);
  if (prepare) prepare();
  execv(argv[0], argv.data());
  _exit(127);
}

Running::~Running() {
  if (pid_ > 0) {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  unlink(out_.c_str());
  unlink(err_.c_str());
}

double Running::processor_seconds() const {
  clockid_t clock{};
  timespec t{};
  if (clock_getcpuclockid(pid_, &clock) != 0 || clock_gettime(clock, &t) != 0) return 0;
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

std::string Running::output() const {
  return read_file(out_);
}

void Running::let_work(double seconds) const {
  const auto has_ended = [&] {
    siginfo_t info{};
    return waitid(P_PID, id_t(pid_), &info, WEXITED | WNOHANG | WNOWAIT) != 0 || info.si_pid != 0;
  };
  while (processor_seconds() < seconds && !has_ended())
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
}

void Running::send(int signal) {
  seconds_at_signal_ = processor_seconds();
  kill(pid_, signal);
}

Finished Running::wait() {
  int status = 0;
  rusage usage{};
  wait4(pid_, &status, 0, &usage);
  pid_ = -1;
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  Finished f;
  f.processor_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  f.seconds_after_signal = f.processor_seconds - seconds_at_signal_;
  f.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  f.out = read_file(out_);
  f.err = read_file(err_);
  return f;
}

std::string bright_room_pbrt() {
  std::string text = lit_floor_pbrt;
  text += "Material \"diffuse\" \"rgb reflectance\" [0.95 0.95 0.95]\n";
  for (const char* p : {"-2 -2 0  2 -2 0  2 -2 3  -2 -2 3", "-2 2 0  2 2 0  2 2 3  -2 2 3",
                        "-2 -2 0  -2 2 0  -2 2 3  -2 -2 3", "2 -2 0  2 2 0  2 2 3  2 -2 3",
                        "-2 -2 3  2 -2 3  2 2 3  -2 2 3"})
    text += std::string("Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [") +
            p + "]\n";
  return text;
}

Finished run_program(const Folder& folder, const std::vector<std::string>& arguments) {
  return Running(folder, arguments).wait();
}

std::vector<Measured> measured(const Finished& finished) {
  std::istringstream rows(finished.out);
  std::string row;
  std::getline(rows, row);
  std::vector<Measured> values;
  while (std::getline(rows, row)) {
    std::vector<double> v;
    std::istringstream cells(row);
    for (std::string cell; std::getline(cells, cell, ',');) v.push_back(std::stod(cell));
    REQUIRE(v.size() == 11);
    values.push_back({v[9], v[10]});
  }
  return values;
}

std::vector<Measured> measure_direct(const Folder& folder, const std::string& scene,
                                     const std::string& points,
                                     const std::vector<std::string>& options) {
  std::vector<std::string> words{"measure", scene, "--points", points, "--indirect", "none"};
  words.insert(words.end(), options.begin(), options.end());
  const Finished f = run_program(folder, words);
  CAPTURE(f.err);
  REQUIRE(f.status == 0);
  return measured(f);
}

}  // namespace troffer::test
