// Draws the plan of a storey as SVG: floors within their walls, assessed surfaces, luminaires by
// number, and north. report_plans() uses it.
#pragma once

#include <string>
#include <vector>

#include "report/assessment.h"

namespace troffer {

// Parts of the assessment on one level, as indices into Assessment::floors, surfaces and
// luminaires.
struct Storey {
  double height = 0;  // height of its lowest floor along the vertical, m
  std::vector<size_t> floors, surfaces, luminaires;
};

// Groups floors into storeys: floors less than 1.5 m above each other share one. Surfaces and
// luminaires belong to the highest storey below them. Returns one storey if there is no floor.
std::vector<Storey> storeys_of(const Assessment& assessment, const Vec3d& up);

// Returns an SVG element of at most `width` × `height` px. Luminaires carry their index in
// Assessment::luminaires, counted from 1.
std::string plan_plot(const Assessment& assessment, const Storey& storey,
                      const AssessmentOptions& options, double width, double height);

}  // namespace troffer
