// What masks leave open and lists of facets cannot settle: pairs of receiver and cell that wait for
// rays, gathered over all sources of a cluster.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/rgb.h"
#include "base/vec.h"
#include "shadow/found_facets.h"
#include "shadow/mask_points.h"
#include "shadow/shadow_scene.h"

namespace troffer {

// What rays to one source need to know of it.
struct RaySource {
  Vec3d point, normal;   // of its plane; flat sources only: normal towards the receivers
  double tolerance = 0;  // metres above the plane that still belong to it
  bool is_round = false;
  Vec3d centre;  // round: rays end where they first meet this sphere
  double radius = 0;
  uint64_t own = no_round_source;
  FoundFacets* found = nullptr;
  float brightness = 1;  // luminance of its radiance, for the numbers of rays
};

struct RayQueue {
  // `light`, in sr, is open, of `unoccluded` of the whole source; how many rays that is worth is
  // decided over the whole cluster. `random` is the receiver's and the cell's own.
  // passes > 1: one of so many masks of the pair, which follow each other; those that found nothing
  // open may be left out.
  struct OpenPair {
    uint32_t member, source, frame;
    Vec3 origin;
    float light, unoccluded;
    uint64_t random;
    uint32_t passes;
    OpenSamples samples;
  };
  // One ray to each of some points; `light` × the mean of the values of those that are free is the
  // answer.
  struct PointPair {
    uint32_t member, source, first, count;
    Vec3 origin;
    float light;
    bool is_difference;  // of a sum that has been added already: what is hidden varies, not what
                         // is free
  };

  std::vector<RaySource> sources;  // all of the cluster, those without rays too
  std::vector<MaskFrame> frames;   // of cells with rays
  std::vector<OpenPair> open;
  std::vector<PointPair> by_points;
  std::vector<Vec3> points;  // of by_points
  std::vector<Rgb> values;   // at the points

  void clear();
  bool is_empty() const { return open.empty() && by_points.empty(); }
  size_t size() const { return open.size() + by_points.size(); }

  // To the last source, and for open samples to a cell with the last frame.
  void add(uint32_t member, const Vec3& origin, const OpenSamples& samples, float light,
           float unoccluded, uint64_t random, uint32_t passes = 1);
  void add(uint32_t member, const Vec3& origin, std::span<const Vec3> at,
           std::span<const Rgb> values_there, float light, bool is_difference = false);
};

}  // namespace troffer
