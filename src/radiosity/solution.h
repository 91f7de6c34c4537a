// Result of the radiosity preprocessing: irradiance at sample points, by source. Renderers with
// radiosity (`kj92`, `--indirect radiosity`) read it, and it can be saved in a file.
//
// The solution stores irradiance E, in W/m² or lx, and not radiosity B = reflectance × E. A texture
// can then vary within an element, and the ratio of received to unoccluded light is the same.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "radiosity/interpolation.h"
#include "radiosity/meshing.h"

namespace troffer {

constexpr uint32_t no_source = 0xffffffffu;

struct RadiosityOptions {
  MeshingOptions meshing;
  uint32_t stored_per_point = 4;  // contributions stored separately; at most max_stored
  // The solver stops when the unshot power is below this share of the light that reached diffuse
  // surfaces directly from lights.
  float unshot_fraction = 0.01f;
  uint32_t max_shots = 20000;       // limits of effort;
  uint32_t max_million_rays = 400;  // if one is reached, RadiosityEnd says so
  int max_rays = 64;                // per sample point and shooter
  float tolerance = 0.003f;  // error of one transfer, relative to the scene's mean irradiance
  // Minimum number of well-distributed rays to lights whose unoccluded light exceeds `light_share`
  // of the mean irradiance. All of them are traced; 0: as for patches.
  int light_rays = 64;
  float light_share = 0.003f;
  uint64_t seed = 0;
};
constexpr uint32_t max_stored = 64;

// Contribution of one source to one sample point, over all shots. The source is a light of the
// scene or, from light_count on, a patch.
struct StoredContribution {
  uint32_t source = no_source;
  Rgb received;    // irradiance, W/m² or lx, with the visibility of the solution
  Rgb unoccluded;  // the same without occlusion
};

// Luminance of power (W or lm): emitted = absorbed + lost_to_specular + unshot + escaped +
// unaccounted.
struct EnergyBalance {
  double emitted = 0;
  double shot = 0;              // by lights and patches
  double absorbed = 0;          // at sample points
  double lost_to_specular = 0;  // scattered there by other than diffuse lobes
  double unshot = 0;
  double escaped = 0;      // left the scene, estimated by rays from the shooters
  double unaccounted = 0;  // rest: error of mesh and form factors
};

// Reason why the solver ended.
enum class RadiosityEnd : uint32_t { converged, stopped, out_of_shots, out_of_rays };

struct RadiositySolution {
  RadiosityOptions options;
  RadiosityMesh mesh;
  uint32_t light_count = 0;
  uint32_t stored_per_point = 0;
  std::vector<Rgb> general;                // per point: all light that is not stored separately
  std::vector<Rgb> general_direct;         // part of `general` directly from lights
  std::vector<StoredContribution> stored;  // stored_per_point entries per point; unused: no_source
  std::vector<Rgb> shot_radiance;          // per patch: radiance sent over all shots
  // Uniform estimate of the irradiance from unshot power and from power that mirrors, glass and
  // gloss received.
  Rgb ambient;
  float mean_irradiance = 0;  // luminance, predicted from power, area and reflectance
  EnergyBalance balance;
  uint32_t shots = 0;
  uint64_t rays = 0;
  RadiosityEnd end = RadiosityEnd::stopped;
  bool is_complete = false;  // end == converged

  std::span<const StoredContribution> contributions(uint32_t point) const {
    return {stored.data() + size_t(point) * stored_per_point, stored_per_point};
  }
  bool is_light(uint32_t source) const { return source < light_count; }
  uint32_t patch_of(uint32_t source) const { return source - light_count; }
  // Returns the sum of the general value and all stored contributions, in that order. The ambient
  // estimate is not included.
  Rgb irradiance(uint32_t point) const {
    Rgb sum = general[point];
    for (const StoredContribution& c : contributions(point)) sum += c.received;
    return sum;
  }
  size_t memory_bytes() const;
};

// Returns warnings for the user: a balance that does not close within 1 %, a coarsened mesh, an
// early end.
std::vector<std::string> radiosity_warnings(const RadiositySolution& solution);

// Returns the interpolated irradiance, without the ambient estimate.
Rgb interpolated_irradiance(const RadiositySolution& solution, const Interpolation& at);

// Returns a hash of everything in the scene that the solution depends on (collision probability
// 2^-64).
uint64_t radiosity_scene_key(const Scene& scene);

// Returns a solution as file bytes: version, scene key, options, and the data of points and
// patches. The mesh is not stored; loading rebuilds it. Little endian.
std::vector<uint8_t> save_solution(const Scene& scene, const RadiositySolution& solution);

// True if the bytes begin as those of save_solution() do.
bool is_radiosity_solution(std::span<const uint8_t> bytes);

// Reads a solution from file bytes; `file` names the source in errors. Throws InputError if the
// bytes are no solution, are damaged or truncated, or come from an interrupted run. It also throws
// if they belong to another scene or mesh, or to other options than `options` (nullptr: use the
// file's options).
RadiositySolution load_solution(std::span<const uint8_t> bytes, const std::string& file,
                                const Scene& scene, const Tracer& tracer, const BsdfTables& tables,
                                const RadiosityOptions* options, int threads);

}  // namespace troffer
