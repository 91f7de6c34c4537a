// A cluster of receivers as all stages of certified visibility share it: the receivers, their hull,
// and their unoccluded light.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "shadow/shadow_source.h"
#include "shadow/shaft.h"
#include "shadow/unoccluded.h"

namespace troffer {

// A point that receives light.
struct ShadowReceiver {
  Vec3 position;
  Vec3 horizon;     // unit geometric normal; light from below it does not arrive
  Vec3 normal;      // unit shading normal, for the cosine
  Vec3 origin;      // ray origin: position moved off the surface along `horizon`
  uint64_t stream;  // hash of pixel and sample
  // Key of the sequence that a pixel's samples share (0: none), and the sample's number in it.
  uint64_t pixel = 0;
  uint32_t sample = 0;
  float floor = 0;  // brightness × sr: errors are relative to at least this much light
};

// Receivers on one surface that are answered together.
struct ShadowCluster {
  std::span<const ShadowReceiver> receivers;  // at least one; owned by the caller
  ReceiverArrays arrays;                      // positions and normals as separate coordinates
  ReceiverHull hull;                          // hull of all receivers
  bool has_own_horizons = false;              // some receiver's horizon differs from its normal

  // Sets the receivers and keeps the memory.
  void set(std::span<const ShadowReceiver> of);
  size_t size() const { return receivers.size(); }
};

// Returns a convex body that holds the origins of some receivers, at least one.
ReceiverHull hull_of(const ShadowCluster& cluster, std::span<const uint32_t> members);

// Reorders members so that those before the returned index lie on one side of the median along the
// longest axis. The two sets do not depend on the previous order.
size_t halve_members(const ShadowCluster& cluster, std::span<uint32_t> members);

// Sets values[i] to the projected solid angle of the unoccluded source at receiver i, in sr.
// outline: a polygon, the part of the source that counts. For round sources and polygons that are
// parts of a disk, the horizon is that of the normal.
void unoccluded_light(const ShadowCluster& cluster, const FlatSource& source,
                      std::span<const Vec3d> outline, std::vector<float>& values);
void unoccluded_light(const ShadowCluster& cluster, const FlatSource& source,
                      std::vector<float>& values);
void unoccluded_light(const ShadowCluster& cluster, const SphereSource& source,
                      std::vector<float>& values);

}  // namespace troffer
