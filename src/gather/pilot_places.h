// Finds the places at which a pilot asks for light. Used by cell_builder.cpp.
#pragma once

#include <vector>

#include "gather/cell_builder.h"
#include "gather/gather_walks.h"

namespace troffer {

// A place that the pilot asks at: a point, or where the walk of a viewing ray ended.
struct PilotPlace {
  CellHit hit;
  float weight = 0;
  float distance = 0;     // metres of the last segment
  bool is_gloss = false;  // seen by way of gloss: its cell is read directly
};

// Returns the pilot's points, and the matte surfaces that its viewing rays see.
std::vector<PilotPlace> places_of(const CellPilot& pilot, const GatherWalks& walks,
                                  Counters& counters);

}  // namespace troffer
