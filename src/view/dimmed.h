// Sums over dimmers: pictures and measurements by the light of each, as each is set.
#pragma once

#include <string>
#include <vector>

#include "image/image.h"
#include "render/measure.h"
#include "view/layer_board.h"
#include "view/measuring_queue.h"

namespace troffer {

// "1,1,1;0.5,0.5,0.4": three factors between 0 and 1000 for each of `count` dimmers; empty: all 1.
// UsageError for others.
DimmerSettings parse_dimmers(const std::string& text, size_t count);
bool are_all_one(const DimmerSettings& settings);

// The picture on the board: "whole", or the sum of the dimmers' layers where a dimmer is set.
// Throws UsageError if it is not there yet.
Image dimmed_picture(const LayerBoard& board, const DimmerSettings& settings);

// As the measurements of an answer add up; of one by all light together as they are.
std::vector<Measurement> dimmed_measurements(const MeasuringAnswer& answer,
                                             const DimmerSettings& settings);

}  // namespace troffer
