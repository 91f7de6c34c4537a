// Options that bring light to a scene, on the command line: lighting/daylight_options.h says what
// they do.
#pragma once

#include "lighting/daylight_options.h"

namespace CLI {
class App;
}

namespace troffer {

void add_daylight_options(CLI::App& command, DaylightOptions& options);

}  // namespace troffer
