#include "integrate/cells_indirect.h"

#include <algorithm>

#include "base/error.h"

namespace troffer {

namespace {

// Gather rays from what a viewing ray hits; four viewing rays a pixel make 16.
constexpr uint32_t rays_of_hit = 4;

}  // namespace

struct CellsIndirect::Scratch final : IndirectLightScratch {
  CellsScratch cells;
  // Per hit whose rays are in cells.gather.walks: of which viewing ray, and reflectance / π times
  // what the walk carries.
  std::vector<uint32_t> indices;
  std::vector<Rgb> weights;

  void clear() {
    cells.gather.walks.clear();
    indices.clear();
    weights.clear();
  }
};

std::unique_ptr<IndirectLightScratch> CellsIndirect::make_scratch() const {
  return std::make_unique<Scratch>();
}

void CellsIndirect::queue(WaveHits& wave, IndirectLightScratch& scratch, RadianceBatch& out,
                          Counters&) const {
  auto& s = static_cast<Scratch&>(scratch);
  out.tell_shared_error();
  CheckItems items;
  for (size_t i = 0; i < wave.size(); ++i) {
    const SurfaceScattering& scattering = wave.scatterings[i];
    if (!scattering.has_diffuse) continue;
    const Walk& at = wave.walks[i];
    items.at(at.index);
    const Vertex& v = wave.vertices[i];
    const Rgb weight = at.throughput * albedo(scattering.diffuse, v.wo.z) * inv_pi_f;
    const CellHit hit = cell_hit_of(v);
    Rgb irradiance;
    if (at.scatterings > 0 &&
        cells_->indirect_at(hit, wave.hits[i].t * length(at.ray.direction), irradiance)) {
      out.indirect[at.index] += weight * irradiance;
      continue;
    }
    FittedRecord fitted;
    if (at.scatterings == 0 && records_ && !wave.viewing->pixels.empty()) {
      const PixelAt& pixel = wave.viewing->pixels[at.index];
      if (records_->irradiance_at(pixel.x, pixel.y, hit, false, fitted)) {
        out.indirect[at.index] += weight * fitted.irradiance;
        out.shared_error[at.index] += luminance(weight) * fitted.error;
        continue;
      }
    }
    for (uint32_t k = 0; k < rays_of_hit; ++k) {
      Walk walk = at;
      walk.throughput = Rgb{1};
      walk.index = uint32_t(s.indices.size()) * rays_of_hit + k;
      walk.sample = at.sample * rays_of_hit + k;
      set_out(hit, direction_number(walk), walk);
      if (!walk.throughput.is_black()) s.cells.gather.walks.push_back(walk);
    }
    s.indices.push_back(at.index);
    s.weights.push_back(weight);
  }
}

// By the records of the pixel, and by cells.
void CellsIndirect::know(const WaveHits& wave, RadianceBatch& out) const {
  CheckItems items;
  for (size_t i = 0; i < wave.size(); ++i) {
    const SurfaceScattering& scattering = wave.scatterings[i];
    const Walk& at = wave.walks[i];
    if (!scattering.has_diffuse || at.vertex > 0) continue;
    items.at(at.index);
    const Rgb weight = albedo(scattering.diffuse, wave.vertices[i].wo.z) * inv_pi_f;
    const CellHit hit = cell_hit_of(wave.vertices[i]);
    const CellLightAt cell = cells_->light_at(hit);
    const PixelAt& pixel = wave.viewing->pixels[at.index];
    FittedRecord fitted;
    const bool is_fitted = records_->irradiance_at(pixel.x, pixel.y, hit, true, fitted);
    out.known[at.index].direct += weight * cell.direct;
    out.known[at.index].indirect += weight * (is_fitted ? fitted.irradiance : cell.indirect);
  }
}

void CellsIndirect::flush(IndirectLightScratch& scratch, RadianceBatch& out,
                          Counters& counters) const {
  auto& s = static_cast<Scratch&>(scratch);
  cells_->gather(s.indices.size() * rays_of_hit, s.cells, counters);
  for (size_t i = 0; i < s.indices.size(); ++i) {
    Rgb sum;
    float squares = 0;
    for (size_t k = i * rays_of_hit; k < (i + 1) * rays_of_hit; ++k) {
      sum += s.cells.light.irradiance[k];
      squares += sqr(luminance(s.cells.light.irradiance[k]));
    }
    constexpr float n = float(rays_of_hit);
    out.indirect[s.indices[i]] += s.weights[i] * sum * (1 / n);
    if (out.direct_variance.empty()) continue;
    const float variance = std::max(squares / n - sqr(luminance(sum) / n), 0.0f) / (n - 1);
    out.direct_variance[s.indices[i]] += sqr(luminance(s.weights[i])) * variance;
  }
  s.clear();
}

void CellsIndirect::gather(const SensorBatch& sensors, IndirectLightScratch& scratch,
                           RadianceBatch& out, Counters& counters) const {
  auto& s = static_cast<Scratch&>(scratch);
  s.clear();
  for (uint32_t i = 0; i < sensors.size(); ++i) {
    Walk walk = sensor_walk(sensors, i);
    set_out({sensors.positions[i], sensors.normals[i], sensors.normals[i], sensors.offset},
            direction_number(walk), walk);
    s.cells.gather.walks.push_back(walk);
  }
  cells_->gather(sensors.size(), s.cells, counters);
  out.tell_shared_error();
  for (uint32_t i = 0; i < sensors.size(); ++i) {
    out.indirect[i] += s.cells.light.irradiance[i];
    out.shared_error[i] += s.cells.light.half_difference[i];
  }
}

}  // namespace troffer
