// Where people's eyes are: places for cylindrical illuminance and observers for glare.
#pragma once

#include <vector>

#include "report/glare.h"
#include "report/surface.h"
#include "transport/prepared_scene.h"

namespace troffer {

struct EyePlace {
  size_t floor = 0;  // number of the floor it is above
  Vec3d position;    // in the file's coordinates, m
};

// Up to 12 places above each floor, spread over its grid, `height` metres up; none within bodies.
std::vector<EyePlace> eye_places(const PreparedScene& scene,
                                 const std::vector<AssessedSurface>& floors, const Vec3d& up,
                                 double height);

struct PlacedObserver {
  size_t surface = 0;  // number of the surface
  Observer observer;
};

// Four for each level surface: over floors and work planes at the middles of the sides, or as near
// to them as the floor reaches, looking across [CIE 117]; over others at the middle, looking along
// both axes both ways. eye_heights: per surface, m above the floor. None within bodies.
std::vector<PlacedObserver> observers_of(const PreparedScene& scene,
                                         const std::vector<AssessedSurface>& surfaces,
                                         const Vec3d& up, const std::vector<double>& eye_heights);

}  // namespace troffer
