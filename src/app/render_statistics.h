// The file of `render --stats`.
#pragma once

#include <string>

#include "app/commands.h"
#include "render/render.h"
#include "scene/orientation.h"

namespace troffer {

// Times of the steps of the command, in seconds; those named cpu are processor time of all threads.
struct RenderSeconds {
  double import = 0, build = 0, preprocess_cpu = 0, render = 0, render_cpu = 0, write = 0;
};

// Returns the statistics as JSON. `total`: seconds since the start of the command.
std::string statistics_json(const RenderCommand& c, const RenderResult& result,
                            const RenderSeconds& t, double total, const UpDecision& up);

}  // namespace troffer
