// Access to the radiosity solution at hits: the general radiosity by its parts, and the radiosity
// of surfaces. Direct and indirect light of `--method kj92` share it.
#pragma once

#include "kj92/source_selection.h"
#include "radiosity/solution.h"
#include "transport/prepared_scene.h"
#include "transport/vertex.h"
#include "transport/wave.h"

namespace troffer {

// Refers to scene, solution and selection, which must outlive it.
class RadiosityLight {
 public:
  RadiosityLight(const PreparedScene& scene, const RadiositySolution& solution,
                 const SourceSelection& selection)
      : scene_(scene), solution_(solution), selection_(selection) {}

  // Returns the place on the radiosity mesh; `point` is no_point off the mesh.
  RadiosityPlace place_of(const Hit& hit, const Vertex& v) const;
  // Sets wave.places of all diffuse and rough hits, unless they have been set already.
  void places(WaveHits& wave) const;
  uint32_t patch_of(const RadiosityPlace& place) const {
    return solution_.mesh.points[place.point].patch;
  }
  // Returns the irradiance that is not sampled, W/m² or lx; zero off the mesh.
  GeneralIrradiance general(const RadiosityPlace& place) const;
  const RadiositySolution& solution() const { return solution_; }
  const SourceSelection& selection() const { return selection_; }
  // Returns the radiance that the surface at a hit reflects, from the solution alone; zero off the
  // mesh.
  Rgb radiance_seen(const Ray& ray, const Hit& hit) const;

 private:
  const PreparedScene& scene_;
  const RadiositySolution& solution_;
  const SourceSelection& selection_;
};

}  // namespace troffer
