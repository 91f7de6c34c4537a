// Options of long renderings: limits of time and error, checkpoints, parts of a picture.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace troffer {

// Values as typed.
struct LastingOptions {
  double time_limit = 0;   // seconds for everything before outputs are written; 0: no limit
  double error_limit = 0;  // RenderOptions::error_limit
  std::string checkpoint;  // file, or empty
  double checkpoint_interval = 60;  // seconds
  bool is_resumed = false;
  std::string part;  // K/N, or empty
};

void add_lasting_options(CLI::App& app, LastingOptions& options);

// Parses "3/8". Throws UsageError for other texts.
void parse_part(const std::string& text, int& part, int& parts);

struct RenderCommand;
// Sets the command's other options from these. Throws UsageError for contradictory options.
// has_spp: --spp was given.
void apply_lasting_options(RenderCommand& command, bool has_spp);

}  // namespace troffer
