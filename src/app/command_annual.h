// `troffer annual`: a year of daylight at points and grids (annual/annual.h).
#pragma once

#include <string>
#include <vector>

#include "annual/annual.h"
#include "app/commands.h"

namespace troffer {

// Options of `annual`, as typed.
struct AnnualCommand {
  SceneChoice scene;
  std::string weather, output;  // file and folder
  std::string points;           // file, or empty
  GridChoice grid;
  AnnualOptions options;
  double north_deg = 0;
  std::string title;
  bool is_quiet = false;
  std::string command_line;  // as typed
};
void add_annual(CLI::App& app, AnnualCommand& command);  // adds its options
int run_annual(const AnnualCommand& command);

}  // namespace troffer
