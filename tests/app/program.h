// Runs the program as its users do, in a folder of its own.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace troffer::test {

// A new folder under the system's temporary one, removed at the end.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string path(const std::string& name = {}) const { return (path_ / name).string(); }
  // Writes a file and returns its path.
  std::string write(const std::string& name, const std::string& text) const;
  std::vector<std::string> names() const;  // of all entries, hidden ones too, sorted

 private:
  std::filesystem::path path_;
};

std::string read_file(const std::string& path);

struct Finished {
  int status = -1;  // exit status; 128 + signal where one ended it
  std::string out, err;
  double processor_seconds = 0;                  // in all
  double seconds_after_signal = 0;               // of those, the ones after the last send()
  std::vector<std::string> error_lines() const;  // err by lines, as remarks()
  // err without progress lines, and without the last line, which tells files, time and error.
  std::string remarks() const;
};

// A program under way; its standard output and error go to files. Times are the processor's, so
// that a busy machine changes nothing.
class Running {
 public:
  // `prepare` is called in the new process before the program.
  Running(const Folder& folder, const std::vector<std::string>& arguments,
          const std::function<void()>& prepare = {});
  ~Running();
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  // Waits until it has worked for so many seconds, or has ended.
  void let_work(double seconds) const;
  double processor_seconds() const;
  std::string output() const;  // what it has written to standard output so far
  void send(int signal);
  Finished wait();

 private:
  std::string out_, err_;
  int pid_ = -1;
  double seconds_at_signal_ = 0;
};

Finished run_program(const Folder& folder, const std::vector<std::string>& arguments);

// What `measure` has written to its standard output, by points.
struct Measured {
  double lx, error;
};
std::vector<Measured> measured(const Finished& finished);
// Of direct light: `measure --indirect none` of a scene at a CSV's points, which must succeed.
std::vector<Measured> measure_direct(const Folder& folder, const std::string& scene,
                                     const std::string& points,
                                     const std::vector<std::string>& options);

// A floor of 4 × 4 m under a 1 × 1 m source of radiance 5, two metres up, 40 × 30 pixels.
extern const char* const lit_floor_pbrt;
// The same within walls that reflect 0.95, so that light goes to and fro for long.
std::string bright_room_pbrt();

}  // namespace troffer::test
