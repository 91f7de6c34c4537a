// Where a picture's pilot, or a list of points, asks for light.
#pragma once

#include <vector>

#include "gather/cell_builder.h"
#include "gather/gather_walks.h"

namespace troffer {

// Some of the viewing rays' walks ended here.
struct PilotPlace {
  CellHit hit;
  float weight = 0;
  float distance = 0;     // of the last stretch
  bool is_gloss = false;  // seen by way of gloss: its cell itself is asked
};

// Its points, and the matte surfaces that its viewing rays see.
std::vector<PilotPlace> places_of(const CellPilot& pilot, const GatherWalks& walks,
                                  Counters& counters);

}  // namespace troffer
