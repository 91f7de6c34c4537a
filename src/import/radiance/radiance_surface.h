// Radiance's surfaces and distant sources -> geometry and lights.
//
// References: [1] "The RADIANCE 5.1 Synthetic Imaging System", §2.1.1 (surfaces).
#pragma once

#include <map>

#include "import/placed_geometry.h"
#include "import/radiance/radiance_material.h"

namespace troffer {

class RadianceSurfaces {
 public:
  // All must outlive this.
  RadianceSurfaces(Scene& scene, PlacedBounds& bounds, RadianceMaterials& materials)
      : scene_(scene), materials_(materials), placer_(scene, bounds) {}

  static bool is_surface(const std::string& type);

  // A primitive, moved by its `world`, its front turned to the other side where is_inverted.
  // InputError at its place: arguments that cannot be used, too much geometry.
  void add(const RadianceModifier& primitive, const std::string& name, bool is_inverted);
  void add_polygon(const RadianceModifier& primitive, const std::string& name,
                   std::vector<Vec3d> corners, bool is_inverted);
  // Polygons that do not emit are kept by material; this places them.
  void finish();

 private:
  // Polygons of one material: mesh with double positions.
  struct Collected {
    std::vector<Vec3d> positions;
    std::vector<Triangle> triangles;
    SourcePlace place;
  };

  Scene& scene_;
  RadianceMaterials& materials_;
  GeometryPlacer placer_;
  std::map<uint32_t, Collected> collected_;
  size_t triangles_ = 0;

  PlacedLook placed_look(const RadianceLook& look, const std::string& name,
                         const SourcePlace& place) const;
  void add_cone(const RadianceModifier& p, const PlacedLook& look, bool is_inverted);
  void add_ring(const RadianceModifier& p, const PlacedLook& look, bool is_inverted);
  void add_source(const RadianceModifier& p, const std::string& name);
};

}  // namespace troffer
