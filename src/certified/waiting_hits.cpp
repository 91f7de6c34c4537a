#include "certified/waiting_hits.h"

#include "base/random.h"
#include "transport/purposes.h"

namespace troffer {

void WaitingHits::clear() {
  receivers.clear();
  positions.clear();
  horizons.clear();
  weights.clear();
  indices.clear();
  pixels.clear();
  samples.clear();
  draw_streams.clear();
  glossy.clear();
  is_direct.clear();
  is_first.clear();
  glossy_hits.clear();
}

void WaitingHits::add(const Walk& walk, const Vertex& v, const Rgb& weight, bool direct) {
  const Vec3& horizon = v.geometric_normal;
  receivers.push_back({v.surface.position, horizon, v.frame.normal,
                       offset_origin(v.surface, horizon),
                       hash_combine(walk.stream, (uint64_t(walk.vertex) << 32) + walk.sample + 1),
                       hash_combine(walk.stream, walk.vertex), walk.sample});
  positions.push_back(v.surface.position);
  horizons.push_back(horizon);
  weights.push_back(weight);
  indices.push_back(walk.index);
  pixels.push_back(walk.stream);
  samples.push_back(walk.sample);
  draw_streams.push_back(hash_combine(walk.stream, purpose_light(walk.vertex)));
  glossy.push_back(-1);
  is_direct.push_back(direct ? 1 : 0);
  is_first.push_back(walk.vertex == 0 ? 1 : 0);
}

void WaitingHits::add_matte(const Walk& walk, const Vertex& v, Rgb reflectance, bool direct) {
  add(walk, v, walk.throughput * reflectance * inv_pi_f, direct);
}

void WaitingHits::add_glossy(const Walk& walk, const Vertex& v, const SurfaceScattering& scattering,
                             const NominalSourceDensity& competition, bool direct) {
  add(walk, v, walk.throughput, direct);
  glossy.back() = int32_t(glossy_hits.size());
  const SurfacePlace place = scattering.has_rough
                                 ? competition.place(v.surface.position, v.geometric_normal)
                                 : SurfacePlace{v.surface.position, v.geometric_normal};
  glossy_hits.push_back({v.frame, v.wo, place, scattering.diffuse, scattering.specular,
                         scattering.has_diffuse, scattering.has_rough, scattering.is_low_variance,
                         scattering.is_gathered});
}

}  // namespace troffer
