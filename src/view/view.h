// `troffer view`: a page that shows a scene, from start to end.
#pragma once

#include <functional>
#include <string>

#include "view/view_service.h"

namespace troffer {

struct ViewStart {
  uint16_t port = 0;        // 0: any that is free
  std::string tev;          // HOST:PORT of a tev that gets the pictures too; empty: none
  bool has_camera = false;  // ViewSettings::camera is one; else one is placed
  // Is told where the page is, once it is there.
  std::function<void(const std::string& address)> tell;
};

// Serves the page until it asks for the end (true) or `stop` is set (false). Throws
// EnvironmentError where the port, or tev, is not to be had.
bool view(Scene scene, ViewSettings settings, const ViewStart& start, const StopFlag& stop);

}  // namespace troffer
