// Converts Radiance's surfaces and distant sources to geometry and lights. Used by RadianceReader.
// Polygons that do not emit are merged to one mesh per material.
//
// References: [1] "The RADIANCE 5.1 Synthetic Imaging System", §2.1.1 (surfaces).
#pragma once

#include <map>

#include "import/placed_geometry.h"
#include "import/radiance/radiance_material.h"

namespace troffer {

class RadianceSurfaces {
 public:
  // All arguments must outlive this object.
  RadianceSurfaces(Scene& scene, PlacedBounds& bounds, RadianceMaterials& materials)
      : scene_(scene), bounds_(bounds), materials_(materials), placer_(scene, bounds) {}

  static bool is_surface(const std::string& type);

  // Adds a primitive, transformed by its `world`. is_inverted swaps its front and back. Throws
  // InputError, at its place, for unusable arguments and too much geometry.
  void add(const RadianceModifier& primitive, const std::string& name, bool is_inverted);
  void add_polygon(const RadianceModifier& primitive, const std::string& name,
                   std::vector<Vec3d> corners, bool is_inverted);
  // Adds the polygons that do not emit, which are collected by material. Call it last.
  void finish();

 private:
  // Polygons of one material, with positions in double precision.
  struct Collected {
    std::vector<Vec3d> positions;
    std::vector<Triangle> triangles;
    SourcePlace place;
  };

  Scene& scene_;
  PlacedBounds& bounds_;
  RadianceMaterials& materials_;
  GeometryPlacer placer_;
  std::map<uint32_t, Collected> collected_;
  size_t triangles_ = 0;

  ShapeAttributes placed_look(const RadianceLook& look, const std::string& name,
                              const SourcePlace& place) const;
  void add_cone(const RadianceModifier& p, const ShapeAttributes& look, bool is_inverted);
  void add_ring(const RadianceModifier& p, const ShapeAttributes& look, bool is_inverted);
  void add_round_relay(const RadianceModifier& p, const Rgb& reflectance, bool is_inverted);
  void add_source(const RadianceModifier& p, const std::string& name);
};

}  // namespace troffer
