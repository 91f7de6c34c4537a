// Queue of pairs of receiver and source cell that only rays can settle, over all sources of a
// cluster. mask_cell.cpp fills it; residual_rays.h empties it.
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

// A source as its rays need it.
struct RaySource {
  Vec3d point, normal;   // its plane, for flat sources; the normal is towards the receivers
  double tolerance = 0;  // height above the plane that still counts as the source, metres
  bool is_round = false;
  Vec3d centre;  // round sources: rays end where they first meet this sphere
  double radius = 0;
  uint64_t own = no_round_source;
  FoundFacets* found = nullptr;
  float brightness = 1;  // luminance of its radiance; weights the numbers of rays
};

struct RayQueue {
  // A receiver and a cell with open samples. light: open light of the cell, in sr, out of
  // `unoccluded` of the whole source. The number of rays is decided over the whole cluster. random:
  // unique to receiver and cell. passes > 1: one of that many masks of the pair, which follow each
  // other; masks without open samples may be left out.
  struct OpenPair {
    uint32_t member, source, frame;
    Vec3 origin;
    float light, unoccluded;
    uint64_t random;
    uint32_t passes;
    OpenSamples samples;
  };
  // A receiver and some points with one ray each. The answer is `light` × the mean of the values
  // whose rays are free.
  struct PointPair {
    uint32_t member, source, first, count;
    Vec3 origin;
    float light;
    // The pair corrects a sum that has been added already, so the hidden values make up the
    // variance, not the free ones.
    bool is_difference;
  };

  std::vector<RaySource> sources;  // all of the cluster, also those without rays
  std::vector<MaskFrame> frames;   // frames of cells with rays
  std::vector<OpenPair> open;
  std::vector<PointPair> by_points;
  std::vector<Vec3> points;  // sample points of by_points
  std::vector<Rgb> values;   // at the points

  void clear();
  bool is_empty() const { return open.empty() && by_points.empty(); }
  size_t size() const { return open.size() + by_points.size(); }

  // Queues rays to the last source; those through open samples belong to the last frame.
  void add(uint32_t member, const Vec3& origin, const OpenSamples& samples, float light,
           float unoccluded, uint64_t random, uint32_t passes = 1);
  void add(uint32_t member, const Vec3& origin, std::span<const Vec3> at,
           std::span<const Rgb> values_there, float light, bool is_difference = false);
};

}  // namespace troffer
