// Division of the light that arrives at sample points: reflected diffusely, scattered by other
// lobes, absorbed. The solver and UnshotPower use it. Areas are in m²; reflectances are
// hemispherical.
#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/meshing.h"

namespace troffer {

struct PointSurface {
  float area = 0, per_area = 0;  // m² and 1/m²; 0 if not finite
  uint32_t patch = 0;
  bool has_specular = false;
  Rgb reflectance, specular;
};

std::vector<PointSurface> point_surfaces(const RadiosityMesh& mesh);

// Area-weighted mean over all sample points.
struct MeanSurface {
  double area = 0;                 // total, m²
  double diffuse = 0, albedo = 0;  // luminance; albedo: diffuse plus specular
};
MeanSurface mean_surface(const std::vector<PointSurface>& surfaces);

}  // namespace troffer
