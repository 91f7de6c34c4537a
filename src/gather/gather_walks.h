// Rays that ask surfaces around for the light they reflect: what they see of matte surfaces, by way
// of mirrors, glass and gloss too, and what light reaches them along the way.
//
// Emission that a ray runs into first is not counted: light straight from sources is somebody
// else's, and so is that of lights whose image in the mirror that it meets first is one of
// `images`. Behind other mirrors, glass or gloss it is, in competition with one sample of the light
// tree at the gloss, as in path tracing; at wide gloss that sends on little, either only sometimes.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "cells/cell_hit.h"
#include "transport/light_tree_direct.h"
#include "transport/mirror_images.h"
#include "transport/walk.h"

namespace troffer {

// What a surface of wide gloss is, so that its scattering function can be made again.
struct GlossPlace {
  uint32_t material = no_material;  // no_material: there is no wide gloss
  bool is_front = true;
  TexturePlace uv;
  Vec3 wo;

  static constexpr uint32_t no_material = 0xffffffffu;
  bool is_there() const { return material != no_material; }
};

// A matte surface seen by a ray, or, of a view, one of wide gloss, or one that reflects nothing.
struct GatherArrival {
  Walk walk;               // throughput: times the surface's reflectance towards the ray
  CellHit hit;             // where
  GlossPlace gloss;        // of a view
  float gloss_weight = 0;  // luminance that the gloss brings, of the same radiance all around
  float distance = 0;      // from where the ray last left a surface
  float length = 0;        // … from where it set out
};

struct GatherScratch {
  // Rays of a view end where gloss would spread them.
  bool is_view = false;
  // Rays of cells, whose rows are bounded: one that carries more than its share would be cut.
  bool is_of_rows = false;
  std::vector<Walk> walks, next;
  std::vector<GatherArrival> arrivals;  // the result …
  RadianceBatch light;                  // … and radiance from sources: direct + indirect
  std::vector<float> black;             // how far each ray went to where all is swallowed; or 0
  WalkScratch trace;
  std::vector<Vertex> vertices;  // of each walk that hit something
  WaveHits rough;
  LightTreeDirectScratch tree;
};

class GatherWalks {
 public:
  // images: those whose light is somebody else's to count; null: none.
  GatherWalks(const PreparedScene& scene, std::shared_ptr<const MirrorImages> images);

  // Follows s.walks, whose indices are below `rays`, to the end.
  void follow(size_t rays, Coherence coherence, GatherScratch& s, Counters& counters) const;
  // Sends a walk on from a place, by cosine. Returns what light from there counts; so does its
  // throughput, but for light from below the surface.
  float leave(const CellHit& from, const Vec2& number, Walk& walk) const;
  // One such ray of each arrival, in s.walks; the walks have left the arrivals' surfaces.
  void bounce(std::vector<GatherArrival>& arrivals, GatherScratch& s) const;
  SurfaceScattering scattering_at(const GlossPlace& place) const;
  // What the coat at a place lets through (coat_share); all, where there is none.
  Bsdf coat_at(const CellHit& hit) const;
  // A surface there that reflects all, or, of reflectance pi, shows its irradiance; seen from
  // straight above, by way of the coat.
  Bsdf white_at(const CellHit& hit, float reflectance) const;
  // Light straight from sources at arrivals, as irradiance times the walks' throughput, over π, in
  // `light`: one sample each, and one of each image.
  void light_up(const std::vector<GatherArrival>& arrivals, GatherScratch& s,
                Counters& counters) const;

 private:
  void arrive_all(GatherScratch& s) const;
  void leave_scene(const Walk& walk, GatherScratch& s) const;
  void arrive(const Walk& walk, const Hit& hit, const Vertex& v, GatherScratch& s) const;
  void arrive_beyond(const Walk& walk, const Vertex& v, Bsdf& bsdf, float distance,
                     GatherScratch& s) const;
  void see(const Walk& walk, Rgb radiance, float weight, GatherScratch& s) const;
  bool counts(const Walk& walk, uint32_t light) const;
  void light_up_by(const LightTreeDirect& tree, const FlatMirror* mirror,
                   std::span<const GatherArrival> arrivals, GatherScratch& s,
                   Counters& counters) const;
  void go_on(const Walk& walk, const Vertex& v, const SurfaceScattering& scattering, float distance,
             GatherScratch& s) const;
  void note_step(const Walk& before, const Vertex& v, Walk& next) const;

  const PreparedScene& scene_;
  LightTreeDirect tree_;
  // … at arrivals: walks that go on from there do so by cosine, and count no light, under a coat
  // neither.
  LightTreeDirect lit_;
  std::shared_ptr<const MirrorImages> images_;
  std::vector<LightTreeDirect> lit_images_;
};

// Where a ray has hit a surface, as cells want it.
CellHit cell_hit_of(const Vertex& v, const Bsdf& bsdf);
// … and back, as a surface seen from straight above.
Vertex vertex_of(const CellHit& hit);

// Of arrivals side by side that one walk has split into where it met a surface that light passes
// evenly, at either side of it, one is drawn, by what it carries, and stands for both: where walks
// go on again and again they would become a tree.
void keep_one_of_each(std::vector<GatherArrival>& arrivals);

// Sends a walk on from a place, by cosine …
void set_out(const CellHit& from, const Vec2& number, Walk& walk);
// … or in a given direction; its density is that by cosine all the same.
void set_out(const CellHit& from, const Vec3& direction, Walk& walk);

}  // namespace troffer
