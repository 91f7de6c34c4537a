#include "integrate/radiosity_indirect.h"

#include <optional>

#include "base/error.h"
#include "base/warp.h"

namespace troffer {

struct RadiosityIndirect::Scratch final : IndirectLightScratch {
  std::vector<Walk> walks;
  WalkScratch trace;
  struct Patches {
    CertifiedPatchesScratch light;
    ShadowWorld world;
  };
  std::optional<Patches> patches;
};

RadiosityIndirect::RadiosityIndirect(const PreparedScene& scene, const RadiosityLight& radiosity,
                                     std::shared_ptr<const Occluders> occluders,
                                     const CertifiedOptions& of_lights)
    : scene_(scene),
      radiosity_(radiosity),
      occluders_(std::move(occluders)),
      patch_options_(CertifiedPatches::options(of_lights)),
      patches_(scene, radiosity.solution(), radiosity.selection()) {}

std::unique_ptr<IndirectLightScratch> RadiosityIndirect::make_scratch() const {
  auto s = std::make_unique<Scratch>();
  if (occluders_)
    s->patches.emplace(Scratch::Patches{CertifiedPatchesScratch(patch_options_),
                                        ShadowWorld(scene_.scene, *occluders_, scene_.tracer)});
  return s;
}

void RadiosityIndirect::begin(IndirectLightScratch& scratch) const {
  auto& s = static_cast<Scratch&>(scratch);
  if (s.patches) patches_.forget(s.patches->light);
}

void RadiosityIndirect::queue(WaveHits& wave, IndirectLightScratch& scratch, RadianceBatch& out,
                              Counters&) const {
  auto& s = static_cast<Scratch&>(scratch);
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
    if (s.patches)
      patches_.add(walk, wave.vertices[i], reflectance, radiosity_.patch_of(place),
                   s.patches->light);
  }
}

void RadiosityIndirect::flush(IndirectLightScratch& scratch, RadianceBatch& out,
                              Counters& counters) const {
  auto& s = static_cast<Scratch&>(scratch);
  if (s.patches) patches_.illuminate(s.patches->light, s.patches->world, out, counters);
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
