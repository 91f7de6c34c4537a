// Places people's eyes in a scene: points for cylindrical illuminance, and observers for glare.
// assess() uses them. Positions are in the file's coordinates, lengths in metres.
#pragma once

#include <vector>

#include "report/glare.h"
#include "report/surface.h"
#include "transport/prepared_scene.h"

namespace troffer {

// A place for cylindrical illuminance.
struct EyePlace {
  size_t floor = 0;  // index of the floor below
  Vec3d position;    // in the file's coordinates, m
};

// Returns up to 12 places above each floor, spread over its grid, `height` metres up. Places inside
// bodies are left out.
std::vector<EyePlace> eye_places(const PreparedScene& scene,
                                 const std::vector<AssessedSurface>& floors, const Vec3d& up,
                                 double height);

// An observer and the surface it stands at.
struct PlacedObserver {
  size_t surface = 0;  // index of the surface
  Observer observer;
};

// Returns four observers for each level surface, without those inside bodies. At floors and work
// planes they stand at the middles of the sides, or as near as the floor reaches, and look across
// [CIE 117]. At other surfaces they stand at the middle and look along both axes, both ways.
// eye_heights: per surface, m above the floor.
std::vector<PlacedObserver> observers_of(const PreparedScene& scene,
                                         const std::vector<AssessedSurface>& surfaces,
                                         const Vec3d& up, const std::vector<double>& eye_heights);

}  // namespace troffer
