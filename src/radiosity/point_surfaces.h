// What of the light that comes to sample points goes where.
#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/meshing.h"

namespace troffer {

struct PointSurface {
  float area = 0, per_area = 0;  // 0 where it is not finite
  uint32_t patch = 0;
  bool has_specular = false;
  Rgb reflectance, specular;
};

std::vector<PointSurface> point_surfaces(const RadiosityMesh& mesh);

// Of all of them, by area.
struct MeanSurface {
  double area = 0;                 // the sum
  double diffuse = 0, albedo = 0;  // luminance; albedo: diffuse and specular
};
MeanSurface mean_surface(const std::vector<PointSurface>& surfaces);

}  // namespace troffer
