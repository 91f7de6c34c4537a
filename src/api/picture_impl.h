// Implementation of the façade's Picture.
#pragma once

#include "render/render.h"
#include "troffer/render.h"

namespace troffer::api {

struct Picture::Impl {
  RenderResult result;
  RenderStatistics statistics;  // the façade's form of the result's
};

// The façade's form of a result's statistics. build_seconds: of the scene, 0 where it was there.
RenderStatistics statistics_of(const RenderResult& result, double build_seconds);

}  // namespace troffer::api
