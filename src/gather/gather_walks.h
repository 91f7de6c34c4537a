// Follows gather rays to the matte surfaces that they see, also by way of mirrors, glass and gloss,
// and adds up light of sources along the way. Used for gathers, rows of cells and pilot rays.
//
// Emission that a ray meets first does not count, because direct light is computed elsewhere. The
// same holds for lights that the first mirror shows, if it is among `images`. Emission behind other
// mirrors, glass or gloss counts, in competition with one sample of the light tree at the gloss, as
// in path tracing. Wide gloss that sends on little does either only sometimes (Russian roulette).
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "cells/cell_hit.h"
#include "transport/light_tree_direct.h"
#include "transport/mirror_images.h"
#include "transport/walk.h"

namespace troffer {

// Identifies wide gloss on a surface, so that its scattering function can be made again.
struct GlossPlace {
  uint32_t material = no_material;  // no_material: there is no wide gloss
  bool is_front = true;
  TexturePlace uv;
  Vec3 wo;

  static constexpr uint32_t no_material = 0xffffffffu;
  bool is_there() const { return material != no_material; }
};

// Arrival of a ray on a matte surface; in a view, also on wide gloss or on a surface that reflects
// nothing.
struct GatherArrival {
  Walk walk;               // throughput includes the surface's reflectance towards the ray
  CellHit hit;             // place of the arrival
  GlossPlace gloss;        // in a view
  float gloss_weight = 0;  // luminance that the gloss sends under radiance 1 all around
  float distance = 0;      // metres from the surface that the ray left last
  float length = 0;        // metres from where the ray set out
};

// A ray that has left the scene by way of mirrors, glass or gloss, and in which direction.
struct GatherEscape {
  uint32_t index = 0;  // Walk::index
  Vec3 direction;
  Rgb throughput;
};

struct GatherScratch {
  // True for rays of a view, which end where gloss would spread them.
  bool is_view = false;
  // True for rays of cells. Rows are bounded and would cut off heavy rays, so roulette at gloss
  // ends fewer of them and adds less weight.
  bool is_of_rows = false;
  // True for callers that bring light from outside themselves. Straight ways out, which at most
  // pass panes, do not count as escapes: they belong to direct light.
  bool keeps_escapes = false;
  std::vector<Walk> walks, next;
  std::vector<GatherArrival> arrivals;  // result: arrivals
  std::vector<GatherEscape> escapes;    // result: escapes, if kept
  RadianceBatch light;                  // result: radiance from sources, direct + indirect
  std::vector<float> black;  // result: metres that each ray went to a black surface; 0: none
  WalkScratch trace;
  std::vector<Vertex> vertices;  // vertices of each walk that hit something
  // Vertices at which lights are sampled.
  WaveHits rough;
  LightTreeDirectScratch tree;
};

class GatherWalks {
 public:
  // images: mirrors whose light somebody else counts; null: none.
  GatherWalks(const PreparedScene& scene, std::shared_ptr<const MirrorImages> images);

  // Follows s.walks, whose indices are below `rays`, until all have arrived or ended.
  void follow(size_t rays, Coherence coherence, GatherScratch& s, Counters& counters) const;
  // Sends a walk on from a place, cosine-distributed. Returns the coat's factor for light from
  // there, and multiplies the throughput by it. The throughput becomes 0 if the direction is below
  // the surface.
  float leave(const CellHit& from, const Vec2& number, Walk& walk) const;
  // Sends one such ray from each arrival, into s.walks. Changes the arrivals' walks, too.
  void bounce(std::vector<GatherArrival>& arrivals, GatherScratch& s) const;
  // Makes the scattering function at a place again.
  SurfaceScattering scattering_at(const GlossPlace& place) const;
  // Returns a scattering function with the coat at a place (for coat_share()); without a coat, one
  // that lets everything through.
  Bsdf coat_at(const CellHit& hit) const;
  // Returns a white diffuse surface under the coat at a place, seen along its normal. With
  // reflectance π, its radiance equals the irradiance there.
  Bsdf white_at(const CellHit& hit, float reflectance) const;
  // Samples direct light at arrivals, once each and once per mirror image. Adds irradiance ×
  // throughput / π to s.light.
  void sample_direct_light(const std::vector<GatherArrival>& arrivals, GatherScratch& s,
                           Counters& counters) const;

 private:
  void arrive_all(GatherScratch& s) const;
  void leave_scene(const Walk& walk, GatherScratch& s) const;
  void arrive(const Walk& walk, const Hit& hit, const Vertex& v, GatherScratch& s) const;
  void arrive_beyond(const Walk& walk, const Vertex& v, Bsdf& bsdf, float distance,
                     GatherScratch& s) const;
  void see(const Walk& walk, Rgb radiance, float weight, GatherScratch& s) const;
  bool counts(const Walk& walk, uint32_t light) const;
  void light_up_by(const LightTreeDirect& tree, int32_t image,
                   std::span<const GatherArrival> arrivals, GatherScratch& s,
                   Counters& counters) const;
  void go_on(const Walk& walk, const Vertex& v, const SurfaceScattering& scattering, float distance,
             GatherScratch& s) const;
  void note_step(const Walk& before, const Vertex& v, Walk& next) const;

  const PreparedScene& scene_;
  LightTreeDirect tree_;
  // Samples lights at arrivals without competition: walks go on from there cosine-distributed and
  // do not count emission, under a coat either.
  LightTreeDirect lit_;
  std::shared_ptr<const MirrorImages> images_;
  std::vector<LightTreeDirect> lit_images_;
};

// Returns the place where a ray has hit a surface, as cells use it.
CellHit cell_hit_of(const Vertex& v, const Bsdf& bsdf);
// Returns the place as a vertex that is seen from straight above.
Vertex vertex_of(const CellHit& hit);

// Merges neighbouring arrivals that one walk split into at the two sides of a translucent surface
// (transport/two_sides.h). One is drawn in proportion to its throughput and stands for both.
// Otherwise a walk that goes on repeatedly would grow into a tree.
void keep_one_of_each(std::vector<GatherArrival>& arrivals);

// Sends a walk on from a place, cosine-distributed.
void set_out(const CellHit& from, const Vec2& number, Walk& walk);
// Sends a walk on in a given direction. Its density is set to that of the cosine distribution all
// the same.
void set_out(const CellHit& from, const Vec3& direction, Walk& walk);

}  // namespace troffer
