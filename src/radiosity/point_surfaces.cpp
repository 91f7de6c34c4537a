#include "radiosity/point_surfaces.h"

#include <algorithm>

namespace troffer {

namespace {

// Limit on reflectance: at least a thousandth is absorbed. Between perfect reflectors, shooting
// would never end.
constexpr float most_reflected = 0.999f;

}  // namespace

std::vector<PointSurface> point_surfaces(const RadiosityMesh& mesh) {
  std::vector<PointSurface> surfaces;
  surfaces.reserve(mesh.points.size());
  for (const ElementPoint& p : mesh.points) {
    PointSurface s;
    if (p.area < 1e30f) s.area = p.area;
    if (s.area > 1e-30f) s.per_area = 1 / s.area;
    s.patch = p.patch;
    for (size_t c = 0; c < 3; ++c) {
      s.reflectance[c] = std::clamp(p.reflectance[c], 0.0f, most_reflected);
      s.specular[c] = std::clamp(p.specular_albedo[c], 0.0f, most_reflected - s.reflectance[c]);
    }
    s.has_specular = !s.specular.is_black();
    surfaces.push_back(s);
  }
  return surfaces;
}

MeanSurface mean_surface(const std::vector<PointSurface>& surfaces) {
  // limit on the mean reflectance; without it a white room would stay bright for ever
  constexpr double most = 0.98;
  MeanSurface mean;
  double diffuse = 0, all = 0;
  for (const PointSurface& p : surfaces) {
    mean.area += double(p.area);
    diffuse += double(p.area) * double(luminance(p.reflectance));
    all += double(p.area) * double(luminance(p.reflectance + p.specular));
  }
  if (!(mean.area > 0)) return mean;
  mean.diffuse = std::min(diffuse / mean.area, most);
  mean.albedo = std::min(all / mean.area, most);
  return mean;
}

}  // namespace troffer
