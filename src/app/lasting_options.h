// Renderings that last: limits of time and error, checkpoints, shares of a picture.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace troffer {

struct LastingOptions {
  double time_limit = 0;            // seconds, of all the program does before it writes; 0: none
  double error_limit = 0;           // RenderOptions::error_limit
  std::string checkpoint;           // file, or empty
  double checkpoint_interval = 60;  // seconds
  bool is_resumed = false;
  std::string part;  // K/N, or empty
};

void add_lasting_options(CLI::App& app, LastingOptions& options);

struct RenderCommand;
// Makes options of the command of what was typed. UsageError where they do not go together.
// has_spp: --spp was given.
void apply_lasting_options(RenderCommand& command, bool has_spp);

}  // namespace troffer
