// Pictures for a report: as a camera sees the scene, and its luminances as false colours.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "render/render.h"
#include "report/false_colour.h"

namespace troffer {

struct ReportPicture {
  std::string name;  // of the camera
  int width = 0, height = 0;
  std::vector<uint8_t> seen, luminances;  // PNG
  LuminanceScale scale;
  double mean = 0;             // luminance, cd/m²
  double estimated_error = 0;  // root mean square error of a pixel, of the mean; 0: not told
  bool is_complete = true;
};

// options.aovs is taken over with what tells the error.
ReportPicture make_picture(const PreparedScene& scene, const Camera& camera, RenderOptions options,
                           const ProgressCallback& progress, const StopFlag& stop);

}  // namespace troffer
