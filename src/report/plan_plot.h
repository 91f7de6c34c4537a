// The plan of a storey: floors within their walls, assessed surfaces, luminaires by number, north.
#pragma once

#include <string>
#include <vector>

#include "report/assessment.h"

namespace troffer {

// Parts of the assessment on one level; numbers of Assessment::floors, surfaces and luminaires.
struct Storey {
  double height = 0;  // of its lowest floor along the vertical, m
  std::vector<size_t> floors, surfaces, luminaires;
};

// Floors that lie less than 1.5 m over each other are one storey; surfaces and luminaires belong to
// the highest storey under them. One storey where there is no floor.
std::vector<Storey> storeys_of(const Assessment& assessment, const Vec3d& up);

// An SVG element of at most `width` × `height` px. Luminaires have their numbers in
// Assessment::luminaires, from 1.
std::string plan_plot(const Assessment& assessment, const Storey& storey,
                      const AssessmentOptions& options, double width, double height);

}  // namespace troffer
