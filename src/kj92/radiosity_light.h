// The light that the radiosity preprocessing left at a place: the general value, by its parts.
#pragma once

#include "kj92/source_selection.h"
#include "radiosity/solution.h"
#include "transport/prepared_scene.h"
#include "transport/vertex.h"
#include "transport/wave.h"

namespace troffer {

// Solution and selection belong to the scene; all three must outlive it.
class RadiosityLight {
 public:
  RadiosityLight(const PreparedScene& scene, const RadiositySolution& solution,
                 const SourceSelection& selection)
      : scene_(scene), solution_(solution), selection_(selection) {}

  RadiosityPlace place_of(const Hit& hit, const Vertex& v) const;
  // Sets wave.places of all hits that scatter light other than mirrors do, if nobody has yet.
  void places(WaveHits& wave) const;
  uint32_t patch_of(const RadiosityPlace& place) const {
    return solution_.mesh.points[place.point].patch;
  }
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
