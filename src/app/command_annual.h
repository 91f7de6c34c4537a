// `troffer annual`: a year of daylight at points and grids (annual/annual.h).
#pragma once

#include <string>
#include <vector>

#include "annual/annual.h"
#include "app/annual_lasting.h"
#include "app/commands.h"

namespace troffer {

// Options of `annual`, as typed.
struct AnnualCommand {
  SceneChoice scene;
  std::string weather, output;  // file and folder
  std::string points;           // file, or empty
  GridChoice grid;
  std::string groups;  // file, or empty
  AnnualOptions options;
  double north_deg = 0;
  std::string eyes;      // file, or empty
  std::string sunlight;  // file, or empty
  std::string sunlight_day = "03-21";
  std::vector<std::string> electric;  // groups of lights
  double electric_target_lx = 500;
  bool writes_ill = false;
  AnnualLasting lasting;
  std::string title;
  bool is_quiet = false;
};
void add_annual(CLI::App& app, AnnualCommand& command);  // adds its options
// command_line: as typed, for the outputs.
int run_annual(const AnnualCommand& command, const std::string& command_line);

}  // namespace troffer
