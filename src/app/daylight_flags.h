// Command-line options for light that is added to a scene. lighting/daylight_options.h explains
// them.
#pragma once

#include "lighting/daylight_options.h"

namespace CLI {
class App;
}

namespace troffer {

void add_daylight_options(CLI::App& command, DaylightOptions& options);

}  // namespace troffer
