// Runs `troffer view`: a page that shows a scene, from start to end.
#pragma once

#include <functional>
#include <string>

#include "view/view_service.h"

namespace troffer {

// Settings for the start of the page.
struct ViewStart {
  uint16_t port = 0;        // 0: any free port
  bool has_camera = false;  // ViewSettings::camera is set; otherwise one is placed
  // Called with the page's address once it is served.
  std::function<void(const std::string& address)> tell;
  // Called before that, with each note for the user; may be null.
  std::function<void(const std::string& note)> note;
};

// Serves the page until the page asks to close (returns true) or `stop` is set (returns false).
// Throws EnvironmentError if the port is not available.
bool view(Scene scene, ViewSettings settings, const ViewStart& start, const StopFlag& stop);

}  // namespace troffer
