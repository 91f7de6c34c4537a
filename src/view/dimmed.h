// Sums the light of dimmers: pictures and measurements by each luminaire, times its setting.
// The page's downloads of pictures and measurements use it.
#pragma once

#include <string>
#include <vector>

#include "image/image.h"
#include "render/measure.h"
#include "view/layer_board.h"
#include "view/measuring_queue.h"

namespace troffer {

// Parses "1,1,1;0.5,0.5,0.4": three factors between 0 and 1000 for each of `count` dimmers. Empty
// text: all factors are 1. Throws UsageError for anything else.
DimmerSettings parse_dimmers(const std::string& text, size_t count);
bool are_all_one(const DimmerSettings& settings);

// Returns the picture on the board: "whole", or the sum of the dimmers' layers if any setting
// differs from 1. Throws UsageError if a layer is missing.
Image dimmed_picture(const LayerBoard& board, const DimmerSettings& settings);

// Returns the sums of an answer's measurements over dimmers. An answer by all light together is
// returned as measured.
std::vector<Measurement> dimmed_measurements(const MeasuringAnswer& answer,
                                             const DimmerSettings& settings);

}  // namespace troffer
