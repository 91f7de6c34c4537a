// Walks from surface to surface, many at a time. Shared by all methods that trace rays: starting
// and tracing walks, scattering, Russian roulette, MIS weights of emission, batches of shadow rays.
// Densities are per solid angle (1/sr), lengths are in metres.
#pragma once

#include <vector>

#include "transport/batch.h"
#include "transport/connect.h"

namespace troffer {

constexpr int32_t no_medium = -1;

// A ray on its way from one vertex to the next, and the state that the next vertex needs.
struct Walk {
  Ray ray;
  Rgb throughput{1};
  // Density per solid angle of the ray's direction. 0 for camera rays and delta lobes, which do not
  // compete with the sampling of lights.
  float pdf = 0;
  // Previous vertex, not counting panes that the walk passed straight. MIS needs it for the density
  // of sampling a light from there; portals need it for the radiance that they show.
  Vec3 last_position, last_normal;
  bool last_both_sides = false;
  bool is_last = false;      // only emission at the next vertex counts
  uint32_t vertex = 0;       // number of vertices behind it
  uint32_t panes = 0;        // number of those that were panes passed straight
  uint32_t scatterings = 0;  // number of those at which a lobe other than a delta was sampled
  // inverse of the factor by which refraction has scaled radiance so far
  float eta_squared = 1;
  uint32_t index = 0;          // viewing ray in its batch
  uint32_t sample = 0;         // sample number of the pixel
  float length = 0;            // metres before the previous vertex; only gather walks maintain it
  uint32_t last_place = 0;     // the integrator's own note about the previous vertex
  int32_t medium = no_medium;  // material of the absorbing glass around the ray
  RayCone cone;                // footprint at the ray's origin
  uint64_t stream = 0;
};

// Starts one walk per viewing ray. The second form takes only those in [first, last).
void start_walks(const ViewingRays& rays, std::vector<Walk>& walks);
void start_walks(const ViewingRays& rays, size_t first, size_t last, std::vector<Walk>& walks);

// Returns a walk at vertex 0 of a sensor; its ray is still to be chosen.
Walk sensor_walk(const SensorBatch& sensors, uint32_t i);

// Memory for trace_walks.
struct WalkScratch {
  std::vector<Ray> rays;
  std::vector<Hit> hits;
};

// Finds the next hit of each walk: scratch.hits[i] for walks[i].
void trace_walks(const Tracer& tracer, const std::vector<Walk>& walks, Coherence coherence,
                 WalkScratch& scratch, Counters& counters);

// Computes the vertex of a hit and attenuates the walk by the absorbing glass that it came through.
// The glass is known from where the walk entered it, or from a hit on its inside. Nested glass is
// not supported: both bodies end at the first surface of either.
void arrive_at(const Scene& scene, const Hit& hit, Walk& walk, Vertex& v);

// Random numbers at a walk's vertex, by dimension of purpose_scatter: direction (0 and 1), lobe
// (2), Russian roulette of the next vertex (3), side of a diffusely transmitting surface (4).
// left_vertex_number() is called at the next vertex.
Vec2 direction_number(const Walk& walk);
float lobe_number(const Walk& walk);
float left_vertex_number(const Walk& walk);
float side_number(const Walk& walk);
// Number for Russian roulette of spawned walks. It is stratified over samples, so that the share of
// a few rays that survives is close to the survival probability.
float roulette_number(const Walk& walk);
// The roulette_number() of the walk that this one would spawn at its vertex.
float spawning_number(const Walk& walk);

// Returns the number of scatterings, mirror reflections and refractions. Panes passed straight do
// not count.
inline uint32_t bounces(const Walk& walk) {
  return walk.vertex - walk.panes;
}

// Samples a direction by the BSDF and sets the walk's ray. Returns false if the walk ends. A walk
// that goes straight through a pane keeps `pdf`: it still competes with the lights sampled at the
// previous vertex, whose shadow rays pass panes as well.
bool step(Walk& walk, const Vertex& vertex, const Bsdf& bsdf, float lobe, const Vec2& direction);

// Sends a walk straight through the pane at v and attenuates it. Returns false if nothing is left.
bool pass_pane(Walk& walk, const Vertex& v, const Bsdf& bsdf);
// Reflects a walk at the pane at v. Returns false if nothing is left.
bool mirror_at_pane(Walk& walk, const Vertex& v, const Bsdf& bsdf);

// Russian roulette for spawned walks. Walks that carry less than a tenth of the light survive in
// proportion to what they carry, and very long ones with at most 95 %. Survivors are weighted up.
// Returns false if the walk ends.
bool survives_spawning(Walk& walk);
// Returns the survival probability of a walk that carries the share `carried` of the light. It is 1
// from `threshold` up, except for very long walks.
float chance_of_spawning(const Walk& walk, const Rgb& carried, float threshold);
// Lets the walk survive with this probability, decided by `number`, and weights it up. Returns
// false if the walk ends.
bool survives(Walk& walk, float chance, float number);

// Stores albedo, normal, position and shadow record of the first hit in `out`.
void record_first_hit(const Walk& walk, const Vertex& v, const Bsdf& bsdf, RadianceBatch& out);

// Returns the power heuristic's weight of emission that the walk has hit at v, against `samples`
// light samples drawn by `tree` at the previous vertex.
float emission_weight(const PreparedScene& scene, const LightTree& tree, const Walk& walk,
                      const Vertex& v, uint32_t primitive, float samples);

// Returns the power heuristic's weight of a light at infinity that the walk sees as it leaves the
// scene, against `samples` samples of it drawn at the previous vertex.
float miss_weight(const PreparedScene& scene, const Walk& walk, uint32_t primitive, float samples);

// Shadow rays of many vertices, with the light that they carry if unoccluded.
struct ShadowBatch {
  std::vector<Ray> rays;
  std::vector<Rgb> contributions;
  std::vector<uint32_t> indices;
  std::vector<uint8_t> is_direct;
  std::vector<uint8_t> is_occluded;
  PaneFactors factors;
  // Rays from one vertex to one source, and their sample count, for the variance.
  struct Group {
    size_t end;
    uint32_t points;
  };
  std::vector<Group> groups;

  void add(const Ray& ray, Rgb contribution, uint32_t index, bool direct);
  // Ends a group of `points` samples: the rays since the last group. Black samples have no ray.
  void end_group(uint32_t points) { groups.push_back({rays.size(), points}); }
  // Traces all rays, adds the light that arrives to `out`, and empties the batch.
  void resolve(const Tracer& tracer, Coherence coherence, RadianceBatch& out, Counters& counters);

 private:
  void add_variance(RadianceBatch& out) const;
};

}  // namespace troffer
