// What the radiosity preprocessing leaves: irradiance at sample points, by source.
//
// Stored is irradiance E, not radiosity B = reflectance × E: a texture can then vary within an
// element when the solution is displayed, and ratios of received to unoccluded are the same.
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
  uint32_t stored_per_point = 4;  // contributions kept separately; at most max_stored
  // Stop when what is unshot is less than this part of the light that came to diffuse surfaces
  // straight from lights.
  float unshot_fraction = 0.01f;
  uint32_t max_shots = 20000;       // bounds of effort: the solution then is as good as it got,
  uint32_t max_million_rays = 400;  // and says so (RadiosityEnd)
  int max_rays = 64;                // from a sample point to a shooter
  float tolerance = 0.003f;         // of one transfer, in units of the scene's mean irradiance
  // To lights that would give more than `light_share` of the mean irradiance if nothing were in
  // the way, at least this many rays are cast, well spread, and all of them; 0: as to patches.
  int light_rays = 64;
  float light_share = 0.003f;
  uint64_t seed = 0;
};
constexpr uint32_t max_stored = 64;

// What one source gives to one sample point, over all of its shots. The source is a light of the
// scene, or, from light_count on, a patch.
struct StoredContribution {
  uint32_t source = no_source;
  Rgb received;    // irradiance, W/m² or lx, with the preprocessing's visibility
  Rgb unoccluded;  // what it would be if nothing were in the way
};

// Luminance of power (W, or lm). emitted = absorbed + lost_to_specular + unshot + escaped +
// unaccounted.
struct EnergyBalance {
  double emitted = 0;
  double shot = 0;              // by lights and patches
  double absorbed = 0;          // at sample points
  double lost_to_specular = 0;  // reflected or transmitted there, but not diffusely
  double unshot = 0;
  double escaped = 0;  // left the scene, as rays from what shoots tell
  double unaccounted =
      0;  // neither came to a sample point nor left: error of mesh and form factors
};

// Why a solver ended.
enum class RadiosityEnd : uint32_t { converged, stopped, out_of_shots, out_of_rays };

struct RadiositySolution {
  RadiosityOptions options;
  RadiosityMesh mesh;
  uint32_t light_count = 0;
  uint32_t stored_per_point = 0;
  std::vector<Rgb> general;                // per point: all that is not stored separately
  std::vector<Rgb> general_direct;         // the part of `general` that came straight from lights
  std::vector<StoredContribution> stored;  // stored_per_point of them per point; unused: no_source
  std::vector<Rgb> shot_radiance;          // per patch: the radiance it sent, over all its shots
  // Irradiance expected everywhere from what is unshot, and from what mirrors, glass and gloss
  // took.
  Rgb ambient;
  float mean_irradiance = 0;  // luminance, as expected from power, area, reflectance
  EnergyBalance balance;
  uint32_t shots = 0;
  uint64_t rays = 0;
  RadiosityEnd end = RadiosityEnd::stopped;
  bool is_complete = false;  // end == converged: the unshot power fell as low as was asked for

  std::span<const StoredContribution> contributions(uint32_t point) const {
    return {stored.data() + size_t(point) * stored_per_point, stored_per_point};
  }
  bool is_light(uint32_t source) const { return source < light_count; }
  uint32_t patch_of(uint32_t source) const { return source - light_count; }
  // General value and all stored contributions, in that order; without the ambient estimate.
  Rgb irradiance(uint32_t point) const {
    Rgb sum = general[point];
    for (const StoredContribution& c : contributions(point)) sum += c.received;
    return sum;
  }
  size_t memory_bytes() const;
};

// What a user should be told of a solution: a balance that does not close within 1 %, an early end.
std::vector<std::string> radiosity_warnings(const RadiositySolution& solution);

// Irradiance at a place, without the ambient estimate.
Rgb interpolated_irradiance(const RadiositySolution& solution, const Interpolation& at);

// A number that differs for scenes whose solutions differ (but by chance of 2^-64).
uint64_t radiosity_scene_key(const Scene& scene);

// A solution as a file: version, the scene's key, options, and what points and patches carry; the
// mesh is made anew when it is loaded. Little endian.
std::vector<uint8_t> save_solution(const Scene& scene, const RadiositySolution& solution);

// `file` names the source in errors. Throws InputError where the bytes are no solution, are damaged
// or cut short, belong to another scene, or were computed with other options than `options`
// (nullptr: the file's own are taken).
RadiositySolution load_solution(std::span<const uint8_t> bytes, const std::string& file,
                                const Scene& scene, const Tracer& tracer, const BsdfTables& tables,
                                const RadiosityOptions* options, int threads);

}  // namespace troffer
