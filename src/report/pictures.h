// Renders pictures for a report: the camera's view, and its luminance in false colours.
// The `report` command calls make_picture() for each camera; report_page() embeds the PNGs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "render/render.h"
#include "report/false_colour.h"

namespace troffer {

// A rendered view.
struct ReportPicture {
  std::string name;  // name of the camera
  int width = 0, height = 0;
  std::vector<uint8_t> seen, luminances;  // PNG
  LuminanceScale scale;
  double mean = 0;             // luminance, cd/m²
  double estimated_error = 0;  // root mean square error of a pixel, relative to the mean; 0:
                               // unknown
  bool is_complete = true;
};

// Renders the camera's view. options.aovs is replaced by the error alone. The picture is empty and
// incomplete if `stop` ended the rendering.
ReportPicture make_picture(const PreparedScene& scene, const Camera& camera, RenderOptions options,
                           const ProgressCallback& progress, const StopFlag& stop);

}  // namespace troffer
