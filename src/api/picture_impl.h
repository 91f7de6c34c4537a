// Data behind the public class Picture: layers of the renderer and converted statistics. render()
// fills it in, and picture.cpp reads it. Copies of a Picture share one Impl.
#pragma once

#include "render/render.h"
#include "troffer/render.h"

namespace troffer::api {

struct Picture::Impl {
  RenderResult result;
  RenderStatistics statistics;  // statistics_of(result)
};

// Converts a result's statistics to the public type. `build_seconds` is the time to prepare the
// scene, 0 if it was prepared already.
RenderStatistics statistics_of(const RenderResult& result, double build_seconds);

}  // namespace troffer::api
