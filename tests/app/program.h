// Runs the program as users do, in a folder of its own. All tests of this folder use it.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace troffer::test {

// A new temporary folder, removed by the destructor.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string path(const std::string& name = {}) const { return (path_ / name).string(); }
  // Writes a file and returns its path.
  std::string write(const std::string& name, const std::string& text) const;
  std::vector<std::string> names() const;  // all entries, hidden ones too, sorted

 private:
  std::filesystem::path path_;
};

std::string read_file(const std::string& path);

// Result of a finished program.
struct Finished {
  int status = -1;  // exit status; 128 + signal if a signal ended it
  std::string out, err;
  double processor_seconds = 0;                  // in total
  double seconds_after_signal = 0;               // after the last send()
  std::vector<std::string> error_lines() const;  // lines of err, like remarks()
  // Returns err without progress lines and without the last line, which states files, time and
  // error.
  std::string remarks() const;
};

// A running program; its standard output and error go to files. Times are processor times, so that
// a busy machine changes nothing.
class Running {
 public:
  // `prepare` runs in the new process before the program starts.
  Running(const Folder& folder, const std::vector<std::string>& arguments,
          const std::function<void()>& prepare = {});
  ~Running();
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  // Waits until the program has used so many seconds, or has ended.
  void let_work(double seconds) const;
  double processor_seconds() const;
  std::string output() const;  // standard output so far
  void send(int signal);
  Finished wait();

 private:
  std::string out_, err_;
  int pid_ = -1;
  double seconds_at_signal_ = 0;
};

Finished run_program(const Folder& folder, const std::vector<std::string>& arguments);

// One result of `measure`, as printed to standard output.
struct Measured {
  double lx, error;
};
std::vector<Measured> measured(const Finished& finished);
// Measures direct light: `measure --indirect none` at a CSV's points, which must succeed.
std::vector<Measured> measure_direct(const Folder& folder, const std::string& scene,
                                     const std::string& points,
                                     const std::vector<std::string>& options);

// A floor of 4 × 4 m under a 1 × 1 m source of radiance 5, two metres up; 40 × 30 pixels.
extern const char* const lit_floor_pbrt;
// The same within walls of reflectance 0.95, so that light bounces many times.
std::string bright_room_pbrt();

}  // namespace troffer::test
