#include "kj92/radiosity_light.h"

#include "radiosity/interpolation.h"
#include "transport/bsdf_at.h"

namespace troffer {

RadiosityPlace RadiosityLight::place_of(const Hit& hit, const Vertex& v) const {
  RadiosityPlace place;
  place.is_back = !v.is_front;
  place.fragment = fragment_at(scene_.scene, solution_.mesh, hit.geometry, hit.primitive, hit.u,
                               hit.v, v.surface.position, place.is_back, place.weights);
  if (place.fragment == no_fragment) return place;
  const uint32_t element = solution_.mesh.fragments[place.fragment].element;
  place.point = solution_.mesh.element_points[element][place.is_back ? 1 : 0];
  return place;
}

void RadiosityLight::places(WaveHits& wave) const {
  if (wave.places.size() == wave.size()) return;
  wave.places.assign(wave.size(), {});
  for (size_t i = 0; i < wave.hits.size(); ++i) {
    const SurfaceScattering& s = wave.scatterings[i];
    if (s.has_diffuse || s.has_rough) wave.places[i] = place_of(wave.hits[i], wave.vertices[i]);
  }
}

GeneralIrradiance RadiosityLight::general(const RadiosityPlace& place) const {
  if (place.point == no_point) return {};
  return selection_.general(place.fragment, place.is_back, place.weights);
}

Rgb RadiosityLight::radiance_seen(const Ray& ray, const Hit& hit) const {
  Vertex v;
  make_vertex(scene_.scene, ray, hit, v);
  if (place_of(hit, v).point == no_point) return Rgb{0};
  Interpolation at;
  interpolate(scene_.scene, solution_.mesh, hit.geometry, hit.primitive, hit.u, hit.v,
              v.surface.position, !v.is_front, at);
  Bsdf bsdf = bsdf_at(scene_, v);
  bsdf.through = Rgb{0};  // transmission is not part of the exchange
  return albedo(bsdf, v.wo.z) * inv_pi_f *
         (interpolated_irradiance(solution_, at) + solution_.ambient);
}

}  // namespace troffer
