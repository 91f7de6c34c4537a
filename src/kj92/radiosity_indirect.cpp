#include "kj92/radiosity_indirect.h"

#include "base/error.h"
#include "base/warp.h"

namespace troffer {

struct RadiosityIndirect::Scratch final : IndirectLightScratch {
  std::vector<Walk> walks;
  WalkScratch trace;
};

std::unique_ptr<IndirectLightScratch> RadiosityIndirect::make_scratch() const {
  return std::make_unique<Scratch>();
}

void RadiosityIndirect::queue(WaveHits& wave, IndirectLightScratch&, RadianceBatch& out,
                              Counters&) const {
  radiosity_.places(wave);
  CheckItems items;
  for (size_t i = 0; i < wave.size(); ++i) {
    const SurfaceScattering& scattering = wave.scatterings[i];
    const RadiosityPlace& place = wave.places[i];
    if (!scattering.has_diffuse || place.point == no_point) continue;
    const Walk& walk = wave.walks[i];
    items.at(walk.index);
    const Rgb reflectance = albedo(scattering.diffuse, wave.vertices[i].wo.z);
    out.indirect[walk.index] +=
        walk.throughput * reflectance * inv_pi_f * radiosity_.general(place).indirect;
  }
}

void RadiosityIndirect::gather(const SensorBatch& sensors, IndirectLightScratch& scratch,
                               RadianceBatch& out, Counters& counters) const {
  auto& s = static_cast<Scratch&>(scratch);
  s.walks.clear();
  for (uint32_t i = 0; i < sensors.size(); ++i) {
    Walk walk = sensor_walk(sensors, i);
    const Vertex v = make_sensor_vertex(sensors.positions[i], sensors.normals[i], sensors.offset);
    const Vec3 wi = v.frame.to_world(cosine_hemisphere_from_square(direction_number(walk)));
    walk.ray.origin = offset_origin(v.surface, wi);
    walk.ray.direction = wi;
    walk.vertex = 1;
    s.walks.push_back(walk);
  }
  trace_walks(scene_.tracer, s.walks, Coherence::none, s.trace, counters);
  CheckItems items;
  for (uint32_t i = 0; i < sensors.size(); ++i) {
    if (!s.trace.hits[i].is_valid()) continue;
    items.at(i);
    out.indirect[i] += radiosity_.radiance_seen(s.walks[i].ray, s.trace.hits[i]) * pi_f;
  }
}

}  // namespace troffer
