// Walks from surface to surface, many at a time: what all methods that follow rays share.
#pragma once

#include <vector>

#include "transport/batch.h"
#include "transport/connect.h"

namespace troffer {

constexpr int32_t no_medium = -1;

// A ray under way from one vertex to the next, and what is needed when it arrives.
struct Walk {
  Ray ray;
  Rgb throughput{1};
  // Density per solid angle with which the ray's direction was chosen; 0: by the camera or by a
  // delta lobe, in competition with no sampling of lights.
  float pdf = 0;
  // Where it comes from, through panes as if they were not there: for the density with which a
  // light could have been sampled from there, and for what portals show.
  Vec3 last_position, last_normal;
  bool last_both_sides = false;
  bool is_last = false;  // what it arrives at is asked for its emission alone
  uint32_t vertex = 0;   // how many vertices it has left behind
  uint32_t panes = 0;    // … of which so many straight through panes, as if they were not there
  uint32_t scatterings = 0;    // … by lobes that are not deltas
  float eta_squared = 1;       // by which refraction has scaled radiance so far, inverted
  uint32_t index = 0;          // of the viewing ray in its batch
  uint32_t sample = 0;         // of the pixel
  float length = 0;            // metres that it came before its last vertex, where somebody counts
  uint32_t last_place = 0;     // the integrator's own note about the vertex it comes from
  int32_t medium = no_medium;  // material of the absorbing glass that it is in
  RayCone cone;                // what it stands for, where its ray begins
  uint64_t stream = 0;
};

// One walk per viewing ray …
void start_walks(const ViewingRays& rays, std::vector<Walk>& walks);
// … or for those in [first, last) alone.
void start_walks(const ViewingRays& rays, size_t first, size_t last, std::vector<Walk>& walks);

// One walk of a sensor, at its vertex 0; its ray is still to be chosen.
Walk sensor_walk(const SensorBatch& sensors, uint32_t i);

// Memory for trace_walks.
struct WalkScratch {
  std::vector<Ray> rays;
  std::vector<Hit> hits;
};

// Finds where each walk arrives: scratch.hits[i] for walks[i].
void trace_walks(const Tracer& tracer, const std::vector<Walk>& walks, Coherence coherence,
                 WalkScratch& scratch, Counters& counters);

// The vertex where a walk has hit the scene: makes it, and takes from the walk's light what the
// glass that it came through absorbs. What is inside is known by where the walk went in, and by a
// hit on the inside of glass; glass inside glass ends at the first surface of either.
void arrive_at(const Scene& scene, const Hit& hit, Walk& walk, Vertex& v);

// Random numbers at a walk's vertex, by the dimensions of purpose_scatter: for choosing a direction
// (0 and 1), a lobe (2), whether the next vertex goes on (3; told there), and the side of a surface
// that light passes evenly (4).
Vec2 direction_number(const Walk& walk);
float lobe_number(const Walk& walk);
float left_vertex_number(const Walk& walk);
float side_number(const Walk& walk);
// For Russian roulette of spawned walks: even over the samples, so that of a few rays about as many
// as should go on do.
float roulette_number(const Walk& walk);
// … of what a walk at its vertex would spawn: the roulette_number() of that.
float spawning_number(const Walk& walk);

// How often it has been sent on by a surface: panes that it went straight through do not count.
inline uint32_t bounces(const Walk& walk) {
  return walk.vertex - walk.panes;
}

// Chooses a direction by the BSDF and sets out in it; false where the walk ends. A walk that goes
// straight through a pane still competes with the lights sampled where it set out, since their
// shadow rays pass panes as well.
bool step(Walk& walk, const Vertex& vertex, const Bsdf& bsdf, float lobe, const Vec2& direction);

// Sends a walk straight on through a pane at v, with what this leaves; false for what is no pane.
bool pass_pane(Walk& walk, const Vertex& v, const Bsdf& bsdf);
// Sends a walk back as the pane at v mirrors it.
bool mirror_at_pane(Walk& walk, const Vertex& v, const Bsdf& bsdf);

// Spawned walks that carry less than a tenth of the light go on as rarely as they are weak, and
// carry more; so do those of many vertices, whatever they carry: false where the walk ends.
bool survives_spawning(Walk& walk);
// Their chance; `carried`: of light, by a walk that goes on from where it has got to; goes on for
// sure, but for the last, from `threshold` up.
float chance_of_spawning(const Walk& walk, const Rgb& carried, float threshold);
// Goes on by this chance where `number` says so, and carries more.
bool survives(Walk& walk, float chance, float number);

// Fills in what AOVs want to know of the first surface.
void record_first_hit(const Walk& walk, const Vertex& v, const Bsdf& bsdf, RadianceBatch& out);

// The weight of emission that the walk has run into at v, against `samples` samples of lights drawn
// at the vertex before by `tree` (the power heuristic).
float emission_weight(const PreparedScene& scene, const LightTree& tree, const Walk& walk,
                      const Vertex& v, uint32_t primitive, float samples);

// The weight of a light at infinity that the walk, which has left the scene, sees, against
// `samples` samples of it drawn at the vertex before (the power heuristic).
float miss_weight(const PreparedScene& scene, const Walk& walk, uint32_t primitive, float samples);

// Shadow rays with what they carry, gathered over many vertices.
struct ShadowBatch {
  std::vector<Ray> rays;
  std::vector<Rgb> contributions;
  std::vector<uint32_t> indices;
  std::vector<uint8_t> is_direct;
  std::vector<uint8_t> is_occluded;
  PaneFactors factors;
  // Rays of one vertex to one source, with how many points they stand for: where the variance is
  // told.
  struct Group {
    size_t end;
    uint32_t points;
  };
  std::vector<Group> groups;

  void add(const Ray& ray, Rgb contribution, uint32_t index, bool direct);
  // The rays since the last group are what is left of so many points, of which others were black.
  void end_group(uint32_t points) { groups.push_back({rays.size(), points}); }
  // Traces all, adds what arrives to `out`, and empties the batch.
  void resolve(const Tracer& tracer, Coherence coherence, RadianceBatch& out, Counters& counters);

 private:
  void enable_variance(RadianceBatch& out) const;
};

}  // namespace troffer
