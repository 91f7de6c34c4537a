// The light that the radiosity preprocessing left at a place: the general value, by its parts.
#pragma once

#include "integrate/prepared_scene.h"
#include "integrate/vertex.h"
#include "radiosity/solution.h"
#include "select/source_selection.h"

namespace troffer {

// Where a vertex lies on the radiosity mesh.
struct RadiosityPlace {
  uint32_t fragment = no_fragment;
  uint32_t point = no_point;  // no_point: off the mesh, nothing is known here
  bool is_back = false;       // of the fragment
  Vec3 weights;
};

// Solution and selection belong to the scene; all three must outlive it.
class RadiosityLight {
 public:
  RadiosityLight(const PreparedScene& scene, const RadiositySolution& solution,
                 const SourceSelection& selection)
      : scene_(scene), solution_(solution), selection_(selection) {}

  RadiosityPlace place_of(const Hit& hit, const Vertex& v) const;
  // Irradiance that is not sampled, W/m² or lx; zero off the mesh.
  GeneralIrradiance general(const RadiosityPlace& place) const;
  const RadiositySolution& solution() const { return solution_; }
  const SourceSelection& selection() const { return selection_; }
  // Radiance that a surface which a ray has hit reflects, all of it, by the solution alone; zero
  // off the mesh.
  Rgb radiance_seen(const Ray& ray, const Hit& hit) const;

 private:
  const PreparedScene& scene_;
  const RadiositySolution& solution_;
  const SourceSelection& selection_;
};

}  // namespace troffer
