// `troffer report`: its options, and what they ask to assess.
#pragma once

#include <string>
#include <vector>

#include "app/commands.h"
#include "report/assessment.h"

namespace troffer {

// Options of `report`, as typed.
struct ReportCommand {
  SceneChoice scene;
  std::string output;  // output folder
  std::string title, date;
  std::string compare;  // another report's report.json; empty: none
  std::vector<std::string> lights;
  DaylightOptions daylight;
  std::vector<std::string> surfaces;       // NODE[:PROFILE]
  std::vector<std::string> surface_files;  // JSON: surfaces, profiles, observers
  std::string profile = "office-writing";
  std::vector<std::string> power;      // NODE=W
  std::vector<std::string> observers;  // X,Y,Z,DX,DY,DZ
  double maintenance = 0.8, work_plane = 0.75;
  std::string daylight_factor = "auto", contributions = "on", cylindrical = "on", pictures = "on";
  std::vector<std::string> cameras;
  std::string method = "certified";
  double error = 0.01, picture_error = 0.05;
  int spp = 1024, width = 720, threads = 0;
  uint64_t seed = 0;
  bool is_quiet = false;
  std::string command_line;  // as typed
};
void add_report(CLI::App& app, ReportCommand& command);  // adds its options
int run_report(const ReportCommand& command);

// Returns the command line as typed, quoted for a shell, without options that do not change the
// result (--threads).
std::string command_text(int argc, const char* const* argv);

// Returns the settings of the assessment from the command line and its JSON files. up: of the
// scene. Throws UsageError, and InputError with line and column.
AssessmentOptions assessment_options(const ReportCommand& command, const Vec3& up);

}  // namespace troffer
